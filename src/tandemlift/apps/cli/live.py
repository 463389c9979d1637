"""Pages of the browser: `tandemlift live`, whose flight is pushed by hand, `replay` for a saved one, and `page`.

`page` writes a page that flies by itself, without a server.
"""

from __future__ import annotations

import sys
from pathlib import Path

import click

from tandemlift.apps.cli.completion import FLIGHTS, MISSIONS
from tandemlift.apps.cli.console import echo, exit_now, progress_bar
from tandemlift.apps.cli.flying import FAILED, HTML, controller_option, engine_option, load, plugin_option, set_option
from tandemlift.apps.export.results import check_folder, file_path, flight_file
from tandemlift.core.errors import InputError
from tandemlift.core.files import DATA, check_own, write_file

HOST, PORT = "127.0.0.1", 8710
DEFAULT, OUT = "zigzag", Path("out/live")
port_option = click.option(
    "--port", type=int, default=PORT, show_default=True, help="TCP port of the page; 0 for any free one."
)
script_option = click.option("--script", metavar="FILE", help="Begin with the script of a lecture, a .toml file.")
no_browser_option = click.option("--no-browser", is_flag=True, help="Only print the address.")


@click.command()
@click.argument("mission", default=DEFAULT, shell_complete=MISSIONS)
@engine_option
@port_option
@click.option(
    "--host",
    default=HOST,
    show_default=True,
    help="Address to listen on. If other machines can reach it, the page's address carries a token; a QR code has it.",
)
@click.option("--out", metavar="DIR", default=str(OUT), show_default=True, help="Folder for flights saved in the page.")
@script_option
@no_browser_option
@set_option
@controller_option()
def live(
    mission: str,
    engine: str,
    port: int,
    host: str,
    out: str,
    no_browser: bool,
    settings: tuple[str, ...],
    controller: str | None,
    script: str | None = None,
) -> None:
    """Fly MISSION in real time, and push it by hand in the browser.

    MISSION is a built-in mission (see `tandemlift missions`) or the path of a .toml file. The default is zigzag, the
    paper's corridor. The mission's own pushes and person are omitted: only you push. The page can choose another
    mission, or fly a file that is dropped on it. The page is served on this machine only, unless --host says otherwise.
    Ctrl-C ends the flight.

    \b
    Examples:
      tandemlift live
      tandemlift live zigzag --out out/mine
      tandemlift live hover --set admittance.mass=2 --port 0 --no-browser
      tandemlift live hover --controller my_pd.py
      tandemlift live hover --script lecture.toml
    """
    from tandemlift.apps.live.page_files import page_files, with_script
    from tandemlift.apps.live.server import PageServer, serve_until_interrupt
    from tandemlift.apps.live.session.two_flights import TwoFlights
    from tandemlift.engines.registry import engine_named
    from tandemlift.missions import built_in

    engine_named(engine)
    check_folder("--out", out)
    flown = load(mission, settings, controller)
    files = with_script(page_files(), script, [flown.mission.name, *built_in()])
    session = TwoFlights(flown, engine, Path(out))
    serve_until_interrupt(PageServer(files, session, host, port), f"{mission}, live", echo, browser=not no_browser)
    exit_now(0)  # a thread may still be compiling


@click.command()
@click.argument("flight", shell_complete=FLIGHTS)
@click.option("--html", metavar="FILE", help="Write the page to a file that needs no network, instead of serving it.")
@port_option
@no_browser_option
def replay(flight: str, html: str | None, port: int, no_browser: bool) -> None:
    """Play a saved flight in the browser, with a slider for time.

    FLIGHT is flight.npz or its folder. The page is served on this machine only. Ctrl-C ends it.

    \b
    Examples:
      tandemlift replay out/zigzag
      tandemlift replay out/zigzag --html zigzag.html
    """
    from tandemlift.apps.live.page_files import page_files
    from tandemlift.apps.live.replay import replay_files, replay_html
    from tandemlift.flight.record import Flight

    _, saved = flight_file(flight)
    if saved is None:
        raise InputError(f"{flight}: there is no flight.npz; give the file, or the folder that `tandemlift run` wrote")
    path = file_path("--html", html, *HTML) if html else None
    loaded = Flight.load(saved)
    if path:
        write_file(path, replay_html(loaded, page_files()))
        echo(f"{loaded.name}: {path}")
        return
    from tandemlift.apps.live.server import PageServer, serve_until_interrupt

    server = PageServer(replay_files(loaded, page_files()), host=HOST, port=port)
    serve_until_interrupt(server, loaded.name, echo, browser=not no_browser)


@click.command()
@click.argument("missions", nargs=-1, shell_complete=MISSIONS)
@click.option("--out", metavar="DIR", help="Write the page as files for a web server.")
@click.option("--html", metavar="FILE", help="Write the page as one file, which works from disk.")
@script_option
@controller_option("Controller to fly all of them")
@plugin_option
def page(
    missions: tuple[str, ...], out: str | None, html: str | None, script: str | None, controller: str | None
) -> None:
    """Write a page that flies in the browser, without a server.

    The page flies by itself, and is pushed by hand. MISSIONS are those of its menu, the first of which it begins with:
    built-in missions, or the paths of .toml files. The default is hover, zigzag, iris, doorway and rotor-loss. A flight
    saved in the page can be flown again by `tandemlift run`. What is compiled is kept for the next time.

    \b
    Examples:
      tandemlift page --html tandemlift.html
      tandemlift page --out out/page
      tandemlift page zigzag mine.toml --html corridor.html
      tandemlift page hover --controller my_pd.py --html mine.html
      tandemlift page hover --script lecture.toml --html lecture.html
    """
    if not out and not html:
        raise InputError("give the place of the page: --html FILE for one file, --out DIR for a web server")
    one_file = file_path("--html", html, *HTML) if html else None
    from tandemlift.apps.live import page_modules, pages
    from tandemlift.apps.live.page_files import page_files, with_script

    check_folder("--out", out)
    if out:
        check_own(Path(out) / "index.html", pages.MARK)
    names = [load(one, ()).mission.name for one in missions or page_modules.MISSIONS] if script else []
    files = with_script(page_files(), script, names)
    with progress_bar("Compiling", "missions") as progress:
        flights = page_modules.packed_flights(missions or page_modules.MISSIONS, controller, progress)
    for line in pages.write_page(flights, Path(out) if out else None, one_file, files):
        echo(line)


@click.command()
@click.argument("folder", type=click.Path(path_type=Path))
@click.option(
    "--mission", default=DEFAULT, show_default=True, shell_complete=MISSIONS, help="The mission that all were to fly."
)
@click.option("--free", metavar="KEY", multiple=True, help="A key, or a table of keys, that participants may change.")
@set_option
def score(folder: Path, mission: str, free: tuple[str, ...], settings: tuple[str, ...]) -> None:
    """Rank the flights of a challenge: through a corridor by hand.

    Each is flown again from its recording, and scored. FOLDER holds the flights that participants saved in the page of
    `tandemlift live` or `tandemlift page`, by *Challenge*, a folder or a .zip each. The score is a time, and the lowest
    wins: the time from the first push to the end of the corridor, 5 s for each touch of a wall, 1 s for 5 N s of
    effort, and the logarithm of the dimensionless jerk. A flight of another mission, or with a score that its recording
    does not fly, is refused with its reason.

    \b
    Examples:
      tandemlift score handed-in
      tandemlift score handed-in --mission zigzag --free admittance

    Exit code 3: some were refused.
    """
    from tandemlift.apps.live.session.ranking import ranked

    with progress_bar("Flying", "flights") as progress:
        table, refused = ranked(folder, load(mission, settings), free, progress)
    echo(*table)
    sys.exit(FAILED if refused else 0)


@click.command()
@click.argument("folder", type=click.Path(path_type=Path))
@click.option("--exercises", type=click.Path(path_type=Path), default="exercises", help="Where their checks are.")
@click.option(
    "--seconds", type=click.FloatRange(1.0, 3600.0), default=20.0, show_default=True, help="For each notebook."
)
@click.option("--out", metavar="FILE", help="Write the table as CSV, anew after each notebook.")
def grade(folder: Path, exercises: Path, seconds: float, out: str | None) -> None:
    """Grade the notebooks of a class.

    FOLDER holds the notebooks of exercises that participants handed in, a notebook or a folder each; a script called as
    an exercise, such as 1-admittance.py, is graded, too. Each is run in a process of its own, with the checks that
    stand in --exercises, not with those that were handed in. A notebook that raises, does not end, or opens a solution
    is named with its cell; what cannot be graded, with the reason. Run what you do not trust in a container.

    \b
    Examples:
      tandemlift grade handed-in
      tandemlift grade handed-in --out points.csv
      tandemlift grade exercises/solutions

    Exit code 3: some did not run to their end.
    """
    from tandemlift.apps.teaching.class_table import csv_of, fill, lines_of
    from tandemlift.apps.teaching.grading import Grade
    from tandemlift.apps.teaching.hand_ins import Notebook, notebooks_in

    path = file_path("--out", out, ".csv") if out else None
    notebooks, skipped = notebooks_in(folder, exercises)
    if not notebooks:
        raise InputError("\n".join([f"{folder}: holds no notebook that can be graded", *map(str, skipped)]))
    grades = dict[Notebook, Grade]()
    if path:
        write_file(path, csv_of(notebooks, grades, skipped))
    try:
        with progress_bar("Grading", "notebooks", shown=sys.stderr.isatty()) as progress:
            fill(grades, (notebooks, skipped), exercises, seconds, path, progress)
    finally:  # also of a class that is graded in part
        echo(*lines_of(notebooks, grades, skipped))
    sys.exit(FAILED if any(one.failure for one in grades.values()) else 0)


@click.command()
def docs() -> None:
    """Open the documentation in a browser, without a network.

    In a checkout it is the site that `make docs` or `make docs-quick` built last; before any, its pages as text.
    """
    out, text = DATA.parents[2] / "out", DATA.parents[2] / "docs/index.md"
    built = filter(Path.is_file, [out / name / "index.html" for name in ("site", "site-quick")])
    for page in (DATA / "site/index.html", *sorted(built, key=lambda page: -page.stat().st_mtime), text):
        if page.is_file():
            echo(str(page))
            if page == text:
                echo("as text: `make docs-quick` builds the site in a minute, `make docs` with what tutorials draw")
            click.launch(page.as_uri())
            return
    raise InputError("this installation has no documentation: a wheel of a release has it, and a checkout")
