"""Tables from CSV files: what can be read reads the same in every spelling; every fault is one sentence."""

import os

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from lab.base.errors import LabError
from lab.preset import tables
from lab.preset.tables import read_table
from tests.oracles.presets import error_of

PLAIN = "time,sway\n0,0\n0.5,-1.25e-3\n1,.5\n"
quickly = settings(max_examples=150, deadline=None)


def table(folder, content: str | bytes, needed=("time",), optional=("sway", "roll"), key="motion.history.file"):
    path = folder / "record.csv"
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return read_table(str(path), needed, optional, key)


def fault(path, needed=("time",), optional=("sway", "roll"), key="motion.history.file") -> str:
    return error_of(read_table, str(path), needed, optional, key)


@pytest.mark.parametrize(
    "spelling",
    [
        PLAIN,
        PLAIN.replace("\n", "\r\n"),
        PLAIN.replace("\n", "\r"),
        PLAIN.replace(",", ";"),
        PLAIN.replace(",", " , "),
        PLAIN.rstrip(),
        "\ufeff" + PLAIN,
        '"time","sway"\n"0","0"\n0.5, "-1.25e-3"\n1,+0.5',
        "# of a ship\n\n" + PLAIN.replace("\n", "\n# and so on, and on\n \t\n"),
    ],
)
def test_every_spelling_is_the_same_table(tmp_path, spelling):
    columns = table(tmp_path, spelling)
    assert list(columns) == ["time", "sway"]
    assert columns["time"].tolist() == [0.0, 0.5, 1.0]
    assert columns["sway"].tolist() == [0.0, -1.25e-3, 0.5]
    assert all(column.dtype == np.float64 and column.flags.c_contiguous for column in columns.values())


def test_columns_may_be_in_any_order(tmp_path):
    columns = table(tmp_path, "roll,time\n3,0\n4,1\n")
    assert columns["time"].tolist() == [0.0, 1.0] and columns["roll"].tolist() == [3.0, 4.0]


@given(
    st.lists(
        st.tuples(*[st.floats(allow_nan=False, allow_infinity=False, allow_subnormal=False)] * 2),
        min_size=1,
        max_size=20,
    )
)
@quickly
def test_numbers_come_back_to_the_last_bit(tmp_path_factory, rows):
    text = "time;sway\n" + "".join(f"{a!r};{b!r}\n" for a, b in rows)
    columns = table(tmp_path_factory.getbasetemp(), text)
    assert list(zip(columns["time"].tolist(), columns["sway"].tolist(), strict=True)) == rows


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("", ": empty; a first line with the columns time is needed."),
        ("\n# nothing\n", ": empty;"),
        ("time,sway\n", ": has no numbers below its column names."),
        ("sway\n1\n", ", line 1: the column time is missing."),
        ("\ntime,swy\n", ", line 2: unknown column \"swy\"; did you mean sway?"),
        ("Time,sway\n", ", line 1: unknown column \"Time\"; did you mean time?"),
        ("0,0\n1,1\n", ", line 1: unknown column \"0\"; known here: time, sway, roll."),
        ("time,,sway\n", ", line 1: unknown column \"\"; known here"),
        ("time,sway,time\n", ", line 1: the column time is there twice."),
        ("time,sway\n0,0\n\n1\n", ", line 4: 2 numbers are needed, one a column (got 1)."),
        ("time,sway\n0,0,\n", ", line 2: 2 numbers are needed, one a column (got 3)."),
        ("time,sway\n0,\n", ", line 2: sway is left out; a number is needed."),
        ("time,sway\n0,1 mm\n", ", line 2: sway: a plain number is needed (got \"1 mm\")."),
        ("time;sway\n0;0,5\n", ", line 2: sway: a plain number is needed, with a point before"),
        ("time,sway\n0,1_0\n", ", line 2: sway: a plain number is needed (got \"1_0\")."),
        ("time,sway\n0,NaN\n", ", line 2: sway must be a finite number (got NaN)."),
        ("time,sway\n-Infinity,0\n", ", line 2: time must be a finite number (got -Infinity)."),
        ("time,sway\n0,1e999\n", ", line 2: sway must be a finite number (got 1e999)."),
        ("time,sway\n0,\"1\n", ", line 2: cannot be read: "),
        ("time,sway\n0," + "1" * 200_000, ", line 2: cannot be read: "),
        (b"time,sway\n0,\xff\n", ", line 2: not UTF-8 text."),
        (b"time,sway\n0,\0\n", ", line 2: not text, but binary data."),
        ("time,sway\n0,0\n".encode("utf-16"), ", line 1: not UTF-8 text."),
    ],
)  # fmt: skip
def test_errors_name_key_file_and_line(tmp_path, content, words):
    path = tmp_path / "record.csv"
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    path = os.path.relpath(path) if len(str(path)) > 90 else str(path)
    assert fault(path).startswith(f"motion.history.file: {path}{words}"[:200])


def test_paths_that_are_not_files_are_refused(tmp_path):
    missing = tmp_path / "no.csv"
    assert fault(missing).endswith("no.csv: cannot be read: No such file or directory.")
    assert fault(tmp_path).endswith(": is not a file.")
    assert fault("/dev/zero") == "motion.history.file: /dev/zero: is not a file."
    assert fault("a\0b", key="") == "a?b: is not a file name."
    assert fault("\udc80\ud800").endswith("name.")
    assert "…" in fault("x" * 5000)


def test_a_pipe_does_not_hang(tmp_path):
    os.mkfifo(tmp_path / "pipe.csv")
    assert fault(tmp_path / "pipe.csv").endswith("pipe.csv: is not a file.")


@pytest.mark.skipif(os.geteuid() == 0, reason="root reads everything")
def test_an_unreadable_file_is_refused(tmp_path):
    path = tmp_path / "secret.csv"
    path.write_text(PLAIN)
    path.chmod(0)
    assert fault(path).endswith("secret.csv: cannot be read: Permission denied.")


def test_a_file_that_is_too_large_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(tables, "LARGEST_FILE", 1_000_000)
    path = tmp_path / "large.csv"
    path.write_bytes(b"time\n" + b"1\n" * 500_000)
    assert fault(path).endswith("large.csv: too large for a table (over 1 MB).")


@given(st.binary(max_size=80), st.integers(0, len(PLAIN)))
@example(b"\r\x0b\x1c\x85", 14)
@example("\u2028\u0664".encode(), 16)
@example(b'""', 10)
@quickly
def test_any_bytes_give_numbers_or_one_sentence(tmp_path_factory, noise, place):
    path = tmp_path_factory.getbasetemp() / "noise.csv"
    path.write_bytes(PLAIN.encode()[:place] + noise + PLAIN.encode()[place:])
    try:
        columns = read_table(str(path), ("time",), ("sway",))
    except LabError as error:
        assert "\n" not in str(error) and str(error)[-1] in ".?"
    else:
        assert all(np.isfinite(column).all() and len(column) for column in columns.values())


@given(st.text(alphabet='time,sway;0.5e-+"#\n\r\t naif', max_size=60))
@quickly
def test_any_text_gives_numbers_or_one_sentence(tmp_path_factory, text):
    path = tmp_path_factory.getbasetemp() / "text.csv"
    path.write_bytes(text.encode())
    try:
        columns = read_table(str(path), (), ("time", "sway"))
    except LabError as error:
        assert "\n" not in str(error) and str(error)[-1] in ".?"
    else:
        assert all(np.isfinite(column).all() and len(column) for column in columns.values())
