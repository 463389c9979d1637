"""The page of a study: its numbers are those of the table, it needs nothing else, and trusts no text."""

import math
import re

import numpy as np
import pytest
from html_page import check_page
from scipy import stats
from small_studies import made_up, without_file

import tandemlift as tl
from tandemlift.analysis.studies.design.study_files import load_plan
from tandemlift.analysis.studies.study_rows import StudyRows
from tandemlift.analysis.studies.table import outcome_lines
from tandemlift.analysis.studies.worst import worst_rows
from tandemlift.core.findings import FINDING_NAMES
from tandemlift.pictures.report.page import number
from tandemlift.pictures.report.study.distributions import draw_distributions
from tandemlift.pictures.report.study.maps import axis_of, draw_curves
from tandemlift.pictures.report.study.sections import percent, what_was_flown
from tandemlift.pictures.report.study.study_report import write_study_report

HOSTILE = "<script>alert('x')</script>\"&<img src=http://evil.example/x.png>"
STUDY = {
    "study": {"name": "walls", "missions": ["one-push"], "controllers": ["nftsmc", "pid"], "draws": 200},
    "cases": [{"name": "calm"}, {"name": "windy", "set": {"wind.turbulence": 2.0}}],
    "draw": {
        "plant.mass_scale": {"distribution": "uniform", "low": 0.9, "high": 1.2},
        "admittance.damping": {"distribution": "log-uniform", "low": 3.0, "high": 30.0},
    },
}


def measured(rows):
    """Made-up results: the heavier, the worse; of every hundred rows one crashes and one is refused."""
    chance = np.random.default_rng(rows[0].number)
    mass = np.array([row.varied.get("plant.mass_scale", 1.1) for row in rows])
    place = np.array([row.number % 100 for row in rows])
    flew = place != 50
    outcome = np.select([place == 7, ~flew], ["crashed", "refused"], "landed").tolist()
    reasons = {"crashed": "crashed at 3 s: tilt [deg] = 91", "refused": HOSTILE, "landed": ""}
    error = np.abs(mass - 1.0) + 0.01 * chance.random(len(rows))
    numbers = {f"position_rmse_after_10s_m.{i}": error * k for i, k in enumerate((2.0, 1.0, 0.0))}
    numbers |= {"clearance_min_m": 0.5 - error, "human_work_j": 1.0 + chance.random(len(rows)), "steps": 1_000 + place}
    found = [FINDING_NAMES[0] if value > 0.15 else "" for value in error]
    texts = {"outcome": outcome, "reason": [reasons[o] for o in outcome], "finding_kinds": found}
    known = {name: [v if f else None for v, f in zip(x.tolist(), flew, strict=True)] for name, x in numbers.items()}
    return {**texts, **known, "findings": ["[]"] * len(rows), "events": ["[]"] * len(rows)}


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    return made_up(STUDY, tmp_path_factory.mktemp("studies") / "walls", measured)


@pytest.fixture(scope="module")
def path(study, tmp_path_factory):
    return write_study_report(study, tmp_path_factory.mktemp("report") / "report.html")


@pytest.fixture(scope="module")
def page(path):
    return check_page(path)


@pytest.fixture(scope="module")
def rows(study):
    return study.to_pandas()


def test_the_page_needs_nothing_but_itself(page, path):
    outside = [v for _, a in page.elements for k, v in a.items() if k in ("src", "href", "srcset", "data")]
    assert len(outside) == 2  # distributions and maps
    assert all(value.startswith("data:image/png;base64,") for value in outside)
    assert not re.search(r"@import|url\(|<link|<iframe|fetch\(|XMLHttp", page.text, re.IGNORECASE)
    assert set(re.findall(r"https?://[\w.]+", page.text)) == {"http://evil.example"}  # as text, in a refusal
    assert path.stat().st_size < 3_000_000


def test_no_text_of_a_row_becomes_part_of_the_page(page):
    assert len(page.all("script")) == 1
    assert all(not image["src"].startswith("http") for image in page.all("img"))
    assert "&lt;script&gt;alert" in page.text


def test_outcomes_are_counted_with_their_bounds(page, rows):
    head = page.row("")
    assert head == ["", "rows", "bad\n95 % interval", "landed", "crashed", "refused"]
    for group, part in [*rows.groupby(["controller", "case"]), (("all rows",), rows)]:
        shown = page.row(", ".join(group))
        counts = [int((part["outcome"] == name).sum()) for name in ("landed", "crashed", "refused")]
        bad = counts[1] + counts[2]
        bounds = stats.binomtest(bad, len(part)).proportion_ci(0.95, method="exact")
        interval = f"{percent(bounds.low).removesuffix(' %')} to {percent(bounds.high)}"
        assert [int(cell.replace("\u202f", "")) for cell in (shown[1], *shown[3:])] == [len(part), *counts]
        assert shown[2] == f"{percent(bad / len(part))}\n{interval}"


def test_the_verdict_says_how_many_failed_of_those_that_flew(page, rows):
    flew = rows[rows["outcome"] != "refused"]
    failed = int((flew["outcome"] == "crashed").sum())
    head = page.text.partition("</header>")[0].replace("\u202f", "")
    assert f"{failed} of {len(flew)} flights failed" in head
    assert f"{len(rows) - len(flew)} rows could not be flown and were refused" in head


def test_without_a_failure_the_verdict_says_which_of_its_bounds_is_one_sided(tmp_path):
    def good(rows):
        return measured(rows) | {"outcome": ["landed"] * len(rows)}

    study = made_up({key: STUDY[key] for key in ("study", "draw")}, tmp_path / "good", good)
    head = check_page(write_study_report(study, tmp_path / "good.html")).text.partition("</header>")[0]
    one, two = (percent(1.0 - (1.0 - confidence) ** (1.0 / 400)) for confidence in (0.95, 0.975))
    having = (study.to_pandas()["finding_kinds"] != "").sum()
    assert f'"verdict missed"><strong>None of 400 flights failed; {having} have findings</strong>' in head
    assert f", most often {FINDING_NAMES[0]} ({percent(having / 400)}). With" in head
    assert f"at most {one} fail (one-sided bound; the intervals in the tables are two-sided: 0 to {two})" in head


def test_quantiles_are_those_of_the_rows_that_went_well(page, rows):
    good = rows[rows["outcome"] == "landed"]
    error = 1e3 * np.sqrt((good[[f"position_rmse_after_10s_m.{i}" for i in range(3)]] ** 2).sum(axis=1))
    shown = [row for row in page.rows if row and row[0] == "nftsmc, calm"]
    for values, line, worst in (
        (error, shown[1], np.max),
        (1e3 * good["clearance_min_m"], shown[2], np.min),
        (good["human_work_j"], shown[3], np.max),
    ):
        part = values[(good["controller"] == "nftsmc") & (good["case"] == "calm")].to_numpy()
        wanted = [np.median(part), *np.quantile(part, [0.05, 0.95]), worst(part)]
        assert [cell.split("\n")[0] for cell in line[2:]] == [number(float(value)) for value in wanted]
        bounds = stats.quantile_test(part).confidence_interval(0.95)
        assert line[2].split("\n")[1] == f"{number(float(bounds.low))} to {number(float(bounds.high))}"


def test_findings_are_counted_by_kind_on_the_page_and_in_the_terminal(page, study, rows):
    (shown,) = [row for row in page.rows if row and row[0].startswith(f"{FINDING_NAMES[0]}\n")]
    share = shown[2].partition("\n")[0]
    assert f"most frequent findings of 792 flights: {FINDING_NAMES[0]} ({share})" in list(outcome_lines(study))
    found = rows["finding_kinds"] == FINDING_NAMES[0]
    assert int(shown[1].replace("\u202f", "")) == int(found.sum())
    flew = rows["outcome"] != "refused"
    calm = (rows["controller"] == "nftsmc") & (rows["case"] == "calm")
    assert shown[3].startswith(f"{percent((found & calm).sum() / (flew & calm).sum())}\n")


def test_the_worst_rows_come_first_those_that_failed_and_each_has_its_command(page, study, rows):
    worst = [row for row in page.rows if row and row[0].isdigit()]
    failed = rows[rows["outcome"] == "crashed"].sort_values(["steps", "row"])["row"].tolist()
    assert len(worst) == 10
    assert [int(row[0]) for row in worst[:7]] == failed[:7]
    assert all(row[1].startswith("crashed: at 3 s: tilt [deg] = 91") for row in worst[:7])
    good = rows[rows["outcome"] == "landed"]
    farthest, hardest = (
        good.loc[good[name].idxmax(), "row"] for name in ("position_rmse_after_10s_m.0", "human_work_j")
    )
    assert [int(row[0]) for row in worst[7:9]] == [farthest, hardest]  # the farthest has the least clearance, too
    assert worst[8][1].startswith(f"Human work {number(float(good['human_work_j'].max()))} J; the median of all is")
    for row in worst:
        assert f"tandemlift run --from {study.folder} --row {row[0]}" in row[3]
        assert f"seed {rows['seed'][int(row[0])]}" in row[2]


def test_what_was_flown_is_told(page):
    told = [(row[0], row[1]) for row in page.rows if len(row) == 2]
    assert ("Controllers", "nftsmc, pid") in told
    assert ("Case windy", "wind.turbulence = 2.0") in told
    assert ("Drawn", "admittance.damping: log-uniform, low 3.0, high 30.0 N s/m") in told
    assert ("Draws", "200, sampling random, seed 0") in told
    assert f"tandemlift {tl.__version__}, sources" in page.text


def test_a_factor_has_no_unit(tmp_path):
    factor = {"distribution": "uniform", "relative": True, "low": 0.7, "high": 1.3}
    plan = load_plan({"study": {"name": "light", "missions": ["one-push"]}, "draw": {"admittance.mass": factor}})
    told = list(what_was_flown(tl.Study(tmp_path, plan, ())))
    assert ("Drawn", "admittance.mass: uniform, relative true, low 0.7, high 1.3") in told


def test_the_mass_is_found_to_matter(page, rows):
    """Of errors and clearance, but not of what the person does."""
    shown = {name: page.row(name)[1:] for name in ("plant.mass_scale", "admittance.damping")}
    matters = [abs(float(cell.replace("−", "-"))) > 0.5 for cell in shown["plant.mass_scale"]]
    assert matters == [False, True, True, False]  # of bad outcomes, errors, clearance, work
    assert all(abs(float(cell.replace("−", "-"))) < 0.2 for cell in shown["admittance.damping"])
    good = rows[rows["outcome"] == "landed"]
    wanted = stats.spearmanr(good["plant.mass_scale"], good["clearance_min_m"]).statistic
    assert shown["plant.mass_scale"][2] == f"{wanted:.2f}".replace("-", "−")


def test_bins_of_a_key_that_is_drawn_log_uniform_have_about_as_many_rows_each(study):
    """Of four bins as wide on a linear scale, the first would have log 3.25 / log 10 = 51 % of the rows."""
    axis = axis_of(StudyRows(study), "admittance.damping", 2)
    numbers = np.bincount(axis.cell)
    assert axis.size == len(numbers) >= 4
    assert numbers.max() < 1.5 * numbers.min()


@pytest.mark.parametrize(
    ("values", "scale"),
    [
        ({"low": 1.0, "high": 100.0, "count": 5, "spacing": "log"}, "log"),
        ({"low": 1.0, "high": 100.0, "count": 5}, "linear"),
        ([0.1, 0.2, 1.0, 3.0, 1000.0], "log"),
    ],
)
def test_curves_over_a_grid_have_the_scale_of_its_values(values, scale, tmp_path):
    tables = {"study": {"name": "grid", "missions": ["one-push"]}, "grid": {"admittance.damping": values}}
    rows = StudyRows(made_up(tables, tmp_path / "grid", measured))
    panel = draw_curves(rows, "admittance.damping").axes[0]
    low, high = panel.get_xlim()
    assert panel.get_xscale() == scale
    assert low < rows.varied["admittance.damping"].min() < rows.varied["admittance.damping"].max() < high


def captions(page):
    """The texts below the figures, by their titles."""
    return dict(re.findall(r"<b>Figure \d\. (.*)\.</b> (.*)</figcaption>", page.text))


def test_the_caption_of_maps_names_shares_and_hatched_cells_where_there_are_any(page):
    assert "the share of rows with a bad outcome, and the median" in captions(page)["Maps"]
    assert "Hatched" not in captions(page)["Maps"]


def test_a_legend_of_many_groups_does_not_shrink_the_panels(tmp_path):
    def of(cases):
        tables = {**STUDY, "study": STUDY["study"] | {"draws": 5}, "cases": [{"name": name} for name in cases]}
        figure = draw_distributions(StudyRows(made_up(tables, tmp_path / str(len(cases)), measured)))
        return figure.axes[0].get_window_extent().height / figure.dpi

    assert of([f"a case with a name of many words, number {i}" for i in range(4)]) > 0.9 * of("a")


def test_captions_name_what_curves_and_maps_pool(page):
    assert "Cases are pooled." in captions(page)["Maps"], "two controllers of two cases each"
    assert "pooled" not in captions(page)["Distributions"]


@pytest.mark.thorough
def test_chosen_metrics_are_shown_and_no_others(study, tmp_path):
    text = write_study_report(study, tmp_path / "chosen.html", ["human_work_j"]).read_text("utf-8")
    assert "<h3>Human work [J]</h3>" in text
    assert "Clearance" not in text
    with pytest.raises(tl.InputError, match=r"unknown metric 'human_wrok_j'.*Did you mean 'human_work_j'"):
        write_study_report(study, tmp_path / "chosen.html", ["human_wrok_j"])


@pytest.mark.parametrize("others", [(), ("human_work_j",)])
def test_a_chosen_metric_that_no_row_has_is_told_and_the_rest_is_written(others, study, tmp_path):
    metrics = ["push_triggers_after_10s", *others]
    text = write_study_report(study, tmp_path / "chosen.html", metrics).read_text("utf-8")
    assert "No row has a value of <code>push_triggers_after_10s</code>." in text
    assert ("<h3>Human work [J]</h3>" in text) == bool(others)
    assert "Clearance" not in text
    assert "<h2>Worst rows</h2>" in text


@pytest.mark.parametrize(
    ("grid", "title"),
    [
        ({}, ""),
        ({"admittance.damping": [5.0, 10.0]}, "Over the parameter"),
        ({"wind.model": ["none", "air"], "admittance.damping": [5.0, 10.0]}, "Maps"),
        (
            {"pushes": [[{"force": [f, 0.0, 0.0], "time": 0.1}] * bool(f) for f in (1.0, 2.0, 0.0)]},
            "Over the parameter",
        ),
    ],
)
def test_small_studies_have_a_page_with_a_map_over_their_grid(grid, title, tmp_path):
    study = made_up({"study": {"name": "small", "missions": ["one-push"]}, "grid": grid}, tmp_path / "small", measured)
    page = check_page(write_study_report(study, tmp_path / "report.html"))
    assert page.row("all rows")[:2] == ["all rows", str(math.prod(map(len, grid.values())))]
    assert "None N" not in page.text  # of a push that a row does not have
    assert list(captions(page))[1:] == [title] * bool(title)
    assert "bad outcome" not in captions(page).get(title, "")  # of which there are none


def test_a_study_all_of_whose_flights_failed_has_a_page_with_the_ten_that_failed_first(tmp_path):
    def crashed(rows):
        return measured(rows) | {"outcome": ["crashed"] * len(rows)}

    study = made_up({"study": STUDY["study"] | {"draws": 20}, "draw": STUDY["draw"]}, tmp_path / "crashed", crashed)
    page = check_page(write_study_report(study, tmp_path / "report.html"))
    assert [row[0] for row in page.rows if row and row[0].isdigit()] == [str(number) for number in range(10)]
    assert captions(page)["Maps"].endswith("Hatched: no row, or of a quantity no row that ended well.")


@pytest.mark.thorough
def test_a_study_that_is_not_finished_says_so_and_an_empty_one_is_refused(study, tmp_path):
    part = without_file(study, 1, tmp_path / "part")
    text = write_study_report(part, tmp_path / "report.html").read_text("utf-8").replace("\u202f", "")
    assert f"{part.missing} of 800 rows are missing" in text
    for file in part.files:
        file.path.unlink()
    with pytest.raises(tl.InputError, match="no row of the study is flown yet"):
        write_study_report(tl.load_study(part.folder), tmp_path / "none.html")
    assert not (tmp_path / "none.html").exists()


def test_a_study_of_one_row_is_in_the_singular(tmp_path):
    one = {"study": {"name": "one", "missions": ["one-push"]}, "grid": {"plant.mass_scale": [1.0]}}
    text = check_page(write_study_report(made_up(one, tmp_path / "one", measured), tmp_path / "report.html")).text
    assert "The flight did not fail" in text
    assert "plant.mass_scale: 1 value, " in text
    assert not re.search(r"\b1 (rows|values|flights)\b", text)
    assert "– to –" not in text


def test_no_row_that_is_better_than_the_median_is_among_the_worst(tmp_path):
    four = {"study": {"name": "four", "missions": ["one-push"]}, "grid": {"plant.mass_scale": [1.0, 1.1, 1.2, 1.3]}}
    rows = StudyRows(made_up(four, tmp_path / "four", measured), ["position_rmse_after_10s_m"])
    assert [int(rows.number[row.place]) for row in worst_rows(rows)] == [3, 2]
