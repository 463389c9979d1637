"""Commands that fly many missions: comparisons, studies, tuning, feel."""
