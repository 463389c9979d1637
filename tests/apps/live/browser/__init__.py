"""A folder whose tests share one browser and one live flight."""
