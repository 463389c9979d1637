"""What of a page does not fit its width: what reaches beyond it, and what has to be scrolled sideways to be read."""

SIDEWAYS = """() => [...document.querySelectorAll("body *")].filter((e) => e.checkVisibility() && e.clientWidth > 0)
  .filter((e) => e.getBoundingClientRect().right > document.documentElement.clientWidth + 1
    || (getComputedStyle(e).overflowX !== "visible" && e.tagName !== "PRE" && e.scrollWidth > e.clientWidth + 1))
  .map((e) => [e.tagName, e.className, e.clientWidth, e.scrollWidth])"""
