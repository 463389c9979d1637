"""What a study flies: its file, what varies, and the rows that follow from it."""
