"""The controller of docs/reference/controllers.md, as a law and in plain Python, and what the page says of it."""

from repository import ROOT

LISTINGS = ROOT / "docs" / "reference" / "listings"
LAW = (LISTINGS / "my_pd.py").read_text("utf-8")
PLAIN = (LISTINGS / "my_pd_plain.py").read_text("utf-8")
GUIDE = (ROOT / "docs" / "reference" / "controllers.md").read_text("utf-8")
