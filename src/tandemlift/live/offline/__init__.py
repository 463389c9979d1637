"""The page that flies without a server: modules of missions, what the page is told of them, and the files of the page."""
