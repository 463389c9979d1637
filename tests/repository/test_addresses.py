"""No tracked file holds the address of a package registry, a mirror or any other machine: clients know their own."""

import re
import subprocess

from repository import ROOT

URL = re.compile(r"\b(?:https?|ftp|ssh|git|rsync)(?:\+\w+)?://([^\s\"'`<>()\[\]/,]*)(/[^\s\"'`<>)]*)?", re.I)
IPV4 = re.compile(r"(?<![\d.=])(?:\d{1,3}\.){3}\d{1,3}(?![\d.])")  # after "==" stands a version
REGISTRIES = re.compile(  # by name, as clients and containers take them without a scheme
    r"pypi\.org|python[h]osted|np[m]js|yarn[p]kg|crates\.io|anaconda\.org|docker\.io|quay\.io|ghcr\.io|ruby[g]ems"
    r"|\b\w*\.?(?:debian|ubuntu|ros)\.org\b|ubuntu\.com|find[-]links|index[-]url|registry\s*=\s*\S*\.",
    re.I,
)
ALLOWED = {  # kinds of addresses: their hosts, with the path where that is part of the kind
    "this machine": r"(?:localhost|127\\?\.0\\?\.0\\?\.1)(?::[^@/]*)?(?:/.*)?",
    "a name that a program fills in": r"(?:[{\\$].*)?",
    "names that no machine has (RFC 2606)": r"[\w{}.-]+\.example(?::\d+)?(?:/.*)?",
    "names of XML namespaces and of JSON Schema": r"www\.w3\.org/.*|json-schema\.org/.*",
    "citations": r"doi\.org/.*",
    "conventions that a document follows": r"(?:keepachangelog|semver)\.com/.*|semver\.org/.*",
    "projects that a page compares with": r"github\.com/(?:spencerfolk/rotorpy|learnsyslab/safe-control-gym)",
    "where packages ask for support, in web/package-lock.json": (
        r"github\.com/sponsors/.*|opencollective\.com/.*|eslint\.org/donate|paulmillr\.com/funding/"
    ),
    "the author in the licence of a package that the page holds": r"paulmillr\.com",
}
LOOPBACK_AND_ALL = r"127(?:\.\d+){3}|0\.0\.0\.0"  # of this machine: its own address, and all that it has


def addresses(text):
    """The addresses in a text that are of no allowed kind."""
    hosts = [match[1] + (match[2] or "") for match in URL.finditer(text)]
    found = [host for host in hosts if not any(re.fullmatch(kind, host) for kind in ALLOWED.values())]
    found += [ip for ip in IPV4.findall(text) if not re.fullmatch(LOOPBACK_AND_ALL, ip)]
    return found + [match[0] for match in REGISTRIES.finditer(text)]


def tracked():
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    return [ROOT / name for name in listed.split("\0") if name]


def test_no_tracked_file_holds_an_address_of_a_kind_that_is_not_allowed():
    found = {}
    for path in tracked():
        try:
            text = path.read_text("utf-8")
        except (UnicodeDecodeError, FileNotFoundError, IsADirectoryError):
            continue  # a picture, or a file that is being moved
        if wrong := addresses(text):
            found[str(path.relative_to(ROOT))] = wrong
    assert found == {}


REFUSED = [  # in parts, for this file is tracked, too
    ("http:", "//deb.", "debian", ".org/debian"),
    ("https:", "//mirror.local/simple"),
    ("https:", "//packages.some-company.com:8443/npm"),
    ("--index", "-url"),
    ("registry", "=packages.local"),
    ("docker", ".io/library/debian"),
    ("10.", "1.2.3"),
    ("git+https:", "//github.com/a/b"),
    ("http:", "//127.0.0.1.evil.com/simple"),
]
FINE = ["http://127.0.0.1:8000/", "http://localhost:11311", "http://evil.example", "f'http://{host}'", "apsw==3.54.1.0"]


def test_an_address_is_found_wherever_it_stands_but_those_of_this_machine_or_of_none_are_allowed():
    assert ["".join(parts) for parts in REFUSED if not addresses(f"pip install x from '{''.join(parts)}' # here")] == []
    assert [text for text in FINE if addresses(text)] == []
