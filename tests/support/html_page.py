"""A written page, parsed."""

from html.parser import HTMLParser

VOID = {"meta", "img", "br"}


class Page(HTMLParser):
    """Elements with their attributes, the rows of all tables, and tags that are not closed or closed out of turn.

    In a cell, `^` stands before a raised text and a new line for a break.
    """

    def __init__(self, text):
        super().__init__()
        self.elements, self.texts, self.rows, self.open, self.amiss = [], [], [], [], []
        self.text = text
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))
        self.texts.append("")
        if tag == "tr":
            self.rows.append([])
        if tag in ("td", "th"):
            self.rows[-1].append("")
        if tag == "br" and self.rows:
            self.rows[-1][-1] += "\n"
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        if self.open[-1:] == [tag]:
            self.open.pop()
        else:
            self.amiss.append(tag)

    def handle_data(self, data):
        if {"td", "th"} & set(self.open):
            self.rows[-1][-1] += data
        if self.open and self.open[-1] == self.elements[-1][0]:
            self.texts[-1] += data

    def of(self, tag, **attributes):
        """Attributes and text of every element of a kind that has some attributes."""
        every = zip(self.elements, self.texts, strict=True)
        return [(found, text) for (name, found), text in every if name == tag and attributes.items() <= found.items()]

    @property
    def policy(self):
        """What the page may load."""
        return self.of("meta", **{"http-equiv": "Content-Security-Policy"})[0][0]["content"]

    def all(self, tag):
        """The attributes of every element of a kind."""
        return [attributes for name, attributes in self.elements if name == tag]

    def row(self, name):
        """The first row that begins with a cell."""
        return next(row for row in self.rows if row and row[0] == name)


def check_page(path):
    """A page in which every tag is closed, in turn."""
    page = Page(path.read_text("utf-8"))
    assert (page.open, page.amiss) == ([], [])
    return page
