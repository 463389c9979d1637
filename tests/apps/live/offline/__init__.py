"""A folder whose tests share one browser."""
