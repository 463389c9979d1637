"""What people look at: figures, pictures and films of flights, reports."""
