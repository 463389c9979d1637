"""What every other module may use: errors of bad input, files written whole, and types."""
