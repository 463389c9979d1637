"""The figures of a flight: each file says what its figure shows and draws it; `registry` lists them."""
