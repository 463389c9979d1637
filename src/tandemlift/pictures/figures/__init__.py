"""The figures of a flight: each file describes and draws one; `registry` lists them."""
