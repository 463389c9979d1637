"""What a push feels like: the response of the admittance, its checks, numbers for a wish, and a search for them."""
