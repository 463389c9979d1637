"""The page that flies without a server: modules of missions, what the page knows of them, the page's files."""
