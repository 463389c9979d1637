"""The person who guides the vehicle: path, arm, strength, delay and tremor; and a hand moved from outside."""
