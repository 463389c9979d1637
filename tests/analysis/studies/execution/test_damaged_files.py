"""A file of results that is not as it was written: it is never read as if it were, and is flown again."""

import shutil

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from study_runs import TWELVE, assert_same_rows, files_of, fly

from tandemlift.analysis.studies.design.study_files import load_plan
from tandemlift.analysis.studies.execution.checked_file import CheckedFile, DamagedFile, write_checked
from tandemlift.analysis.studies.execution.store import open_folder
from tandemlift.analysis.studies.table import load_study
from tandemlift.core.errors import InputError

KEPT = TWELVE | {"keep": {"channels": ["position"], "rows": [0, 5, 20]}}


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    folder = tmp_path_factory.mktemp("studies") / "twelve"
    fly(KEPT, folder, threads=2)
    return folder


@pytest.fixture
def twelve(whole, tmp_path):
    return shutil.copytree(whole, tmp_path / "twelve")


def all_columns(folder):
    study = load_study(folder)
    return study.read(study.columns)


def flipped(content, bit):
    damaged = bytearray(content)
    damaged[bit // 8] ^= 1 << bit % 8
    return bytes(damaged)


def with_damage_in(path, name):
    """The content of a file with a bit changed in the last page of a column."""
    metadata = pq.read_metadata(path)
    column = metadata.row_group(0).column(metadata.schema.names.index(name))
    first = column.dictionary_page_offset if column.has_dictionary_page else column.data_page_offset
    return flipped(path.read_bytes(), 8 * (first + column.total_compressed_size - 1))


def test_no_bit_of_the_rows_can_change_and_be_read_or_taken_for_flown(twelve):
    store = open_folder(load_plan(KEPT), twelve)
    path = store.files.file(name := store.names()[0])
    content = path.read_bytes()
    for column in pq.read_metadata(path).schema.names[::8]:
        path.write_bytes(with_damage_in(path, column))
        assert not store.files.is_flown(name), column
        with pytest.raises(InputError, match=rf"{path.name} is damaged: .* Run the study again: it makes this file"):
            all_columns(twelve)
        path.write_bytes(content)
    for damaged in (
        content[:-1],
        content[: len(content) // 2],
        b"",
        content[:4] + bytes(len(content) - 8) + content[-4:],
    ):
        path.write_bytes(damaged)
        assert not store.files.is_flown(name), len(damaged)
        with pytest.raises(InputError, match=rf"{path.name} is damaged"):
            all_columns(twelve)
    path.write_bytes(content)
    assert store.files.is_flown(name)


def footer_of(content):
    return range(len(content) - 8 - int.from_bytes(content[-8:-4], "little"), len(content))


def test_each_changed_byte_of_a_footer_is_refused_or_harmless(tmp_path):
    columns = {"row": [0, 1], "lift": [0.5, None], "outcome": ["landed", "crashed"], "flight.time": [[0.0, 0.1]] * 2}
    write_checked(pa.table(columns), path := tmp_path / "chunk.parquet", {"study": "a", "version": "1"})
    content, whole, refused = path.read_bytes(), CheckedFile(path).read(), 0
    for at in footer_of(content):
        path.write_bytes(flipped(content, 8 * at + at % 8))
        try:
            read = CheckedFile(path).read()
        except DamagedFile:
            refused += 1
        else:
            assert read.equals(whole), f"byte {at}"
    assert refused > 0.95 * len(footer_of(content))


def test_a_file_without_a_digest_of_its_footer_is_read_as_before(tmp_path):
    columns = pa.table({"row": [0, 1]}).replace_schema_metadata({"tandemlift.chunk": "chunk"})
    pq.write_table(columns, tmp_path / "chunk.parquet", write_page_checksum=True)
    assert CheckedFile(tmp_path / "chunk.parquet").read().to_pydict() == {"row": [0, 1]}


def test_a_changed_name_of_a_column_is_mended_by_flying_again(whole, twelve):
    path, *_ = files_of(twelve).values()
    content = path.read_bytes()
    at = content.index(b"human_work_j", footer_of(content).start)
    path.write_bytes(flipped(content, 8 * at))
    with pytest.raises(DamagedFile, match="with the names of its columns"):
        load_study(twelve).read(["row"])
    assert fly(KEPT, twelve) == 1
    assert_same_rows(whole, twelve)


def test_every_damaged_file_is_flown_again_and_no_other_one(whole, twelve):
    one, other, copied, swapped, with_it, *rest = files_of(twelve).values()
    one.write_bytes(with_damage_in(one, "human_work_j"))
    other.write_bytes(other.read_bytes() + b"\0")
    shutil.copy(rest[0], copied)
    first, second = swapped.read_bytes(), with_it.read_bytes()
    swapped.write_bytes(second)
    with_it.write_bytes(first)
    before = {path: path.stat().st_mtime_ns for path in rest}
    assert fly(KEPT, twelve) == 5
    assert_same_rows(whole, twelve)
    assert {path: path.stat().st_mtime_ns for path in rest} == before


def test_the_file_of_other_rows_or_of_another_study_in_its_place_is_refused(twelve, tmp_path):
    path, other, *_ = files_of(twelve).values()
    fly(KEPT | {"set": {"mission.duration": 0.25}}, tmp_path / "shorter")
    shorter = next(iter(files_of(tmp_path / "shorter").values()))
    for source in (other, shorter):
        shutil.copy(source, path)
        with pytest.raises(DamagedFile, match=rf"{path.name} is damaged: it is not as it was written, or holds other"):
            load_study(twelve).read(["row"])


def test_a_file_that_another_program_wrote_is_refused(twelve):
    path, *_ = files_of(twelve).values()
    table = pq.read_table(path)
    pq.write_table(table.replace_schema_metadata(None), path)
    with pytest.raises(DamagedFile):
        load_study(twelve).read(["row"])


def test_a_damaged_column_does_not_keep_others_from_being_read(twelve):
    path, *_ = files_of(twelve).values()
    path.write_bytes(with_damage_in(path, "human_work_j"))
    study = load_study(twelve)
    assert study.read(["row"])["row"].to_pylist() == list(range(48))
    with pytest.raises(DamagedFile, match="CRC"):
        study.read(["row", "human_work_j"])


def test_any_reader_of_parquet_reads_the_files_and_finds_checksums_of_pages(twelve):
    path, *_ = files_of(twelve).values()
    table = pq.read_table(path, page_checksum_verification=True)
    assert pd.read_parquet(path)["row"].tolist() == table["row"].to_pylist()
    path.write_bytes(with_damage_in(path, "human_work_j"))
    with pytest.raises(OSError, match="CRC"):
        pq.read_table(path, page_checksum_verification=True)
