"""Studies: several controllers or engines compared, and the validation of the pilot."""
