"""SECURITY.md says what the code does: ports, tokens, limits of messages."""

import re

import pytest
from repository import ROOT

import tandemlift as tl
from tandemlift.apps.clients.crazyflie import server as crazyflie
from tandemlift.apps.clients.flight import quadrotors_of
from tandemlift.apps.live import access, dispatch, server, viewers
from tandemlift.apps.live.session import page_messages as page

TEXT = (ROOT / "SECURITY.md").read_text("utf-8")
ROWS = {
    cells[0]: cells[1:]
    for line in TEXT.splitlines()
    if line.startswith("|") and len(cells := [cell.strip() for cell in line.strip("|").split("|")]) == 4
}
LISTENING = {  # files that open a socket for others, and the row of each
    "apps/live/access.py": "`tandemlift live`",
    "apps/clients/crazyflie/server.py": "`tandemlift crazyflie`",
    "apps/clients/mavlink/vehicles.py": "`tandemlift mavlink`",
    "engines/gazebo_server.py": "`--engine gazebo`, `tandemlift gazebo`",  # looks for a port that is free
}


def said(sentence):
    return sentence in " ".join(TEXT.split())


def test_each_file_that_listens_has_its_row():
    source = ROOT / "src" / "tandemlift"
    sockets = re.compile(r"create_server\(|(?:listening|socket|\bs)\.bind\(")
    found = {p.relative_to(source).as_posix() for p in source.rglob("*.py") if sockets.search(p.read_text("utf-8"))}
    assert found == LISTENING.keys()
    assert set(LISTENING.values()) <= ROWS.keys()


@pytest.mark.parametrize("row", ["live", "replay", "crazyflie", "mavlink"])
def test_the_page_is_where_the_table_says_and_needs_no_token_there(row):
    listens, token, who = ROWS[f"`tandemlift {row}`"]
    assert f"TCP {access.PORT} of {access.HOST}" in listens
    assert (access.AccessControl(access.HOST, access.PORT).token == "") == (token == "none")
    assert who.startswith("nobody" if row == "replay" else "every user and program of this machine")


def test_beyond_this_machine_there_is_a_token_of_as_many_bits():
    assert ROWS["`tandemlift live --host …`"][1] == "yes, unless it is this machine's own"
    token = access.AccessControl("0.0.0.0", access.PORT).token
    assert said(f"a random token ({6 * len(token)} bit)")  # base64
    assert access.AccessControl("localhost", access.PORT).token == ""


def test_the_quadrotors_of_clients_are_at_the_ports_of_the_table():
    host, port = "127.0.0.1", crazyflie.PORT
    assert ROWS["`tandemlift crazyflie`"][0].startswith(f"UDP {port}, {port + 1}, … of {host}, one for each quadrotor")
    quadrotors = quadrotors_of(tl.load_mission("crazyflie-stick"))
    with crazyflie.CrazyflieServer(quadrotors, port=0) as served:
        assert [address.rpartition(":")[0] for address in served.addresses] == [f"udp://{host}"] * quadrotors.count
    vehicles = pytest.importorskip("tandemlift.apps.clients.mavlink.vehicles")
    own = vehicles.PORT + vehicles.OWN
    listens = f"UDP {own}, {own + 1}, … of {vehicles.HOST}, one for each quadrotor"
    assert ROWS["`tandemlift mavlink`"][0].startswith(
        f"{listens}, which sends to {vehicles.PORT}, {vehicles.PORT + 1}, …"
    )
    assert said(
        f"at most {vehicles.PACKETS} packets in a control step and answers at most {vehicles.MAX_CLIENTS} clients"
    )


def test_limits_of_messages_are_those_that_are_counted():
    assert said(f"A message has at most {page.MAX_LENGTH:,} characters and {page.MAX_PARTS} parts")
    assert said(f"{page.MAX_SIZE:,} characters, and {page.MAX_FILE_PARTS:,} parts with those of the file")
    rejected = viewers.MAX_MESSAGES // viewers.REFUSAL_COST
    assert said(f"more than {viewers.MAX_MESSAGES:,} messages per second, or {rejected} rejected messages per second")
    share, together = round(100 * viewers.MAX_WORK), round(100 * viewers.ALL_WORK)
    assert said(f"at most {share} % of a processor, those of all viewers {together} %")
    assert said(f"at most {server.MAX_VIEWERS} viewers, and {dispatch.MAX_WAITING} changes that wait")
