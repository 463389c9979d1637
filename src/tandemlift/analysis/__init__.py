"""What is computed about missions and flights: linear models, studies, tuning."""
