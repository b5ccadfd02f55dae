"""Presets and tables by strangers: small files that would take all memory or time, and paths that lead elsewhere."""

import pytest

from lab.preset.find import load
from tests.lab.preset.test_malformed import LISTED, call, refused
from tests.lab.recording.test_trust_recordings import little_memory  # noqa: F401 (a fixture)

LONG = 100_000

# Of some hundred kB each. What tomllib does with a key of many parts grows with the square of their number.
BOMBS = {
    "dotted-key": "a" + ".a" * LONG + " = 1",
    "quoted-key": '"a"' + '."a"' * LONG + " = 1",
    "odd-key": '"="' + '."=,["' * LONG + " = 1",
    "header": "[a" + ".a" * LONG + "]",
    "inline-key": "x = {a" + ".a" * LONG + " = 1}",
    "deep-lists": "x = " + "[" * LONG + "]" * LONG,
    "deep-tables": "x = " + "{a=" * LONG + "1" + "}" * LONG,
    "many-tables": "[[a]]\n" * LONG,
    "many-keys": "\n".join(f"k{k} = 1" for k in range(LONG // 2)),
    "long-text": "title = '" + "x" * 900_000 + "'",
    "long-number": "x = " + "9" * 900_000,
    "long-float": "x = 0." + "9" * 900_000,
}


@pytest.mark.parametrize("name", BOMBS)
def test_a_preset_that_expands_exponentially_is_refused(tmp_path, name, little_memory):  # noqa: F811
    (tmp_path / "bomb.toml").write_text(BOMBS[name])
    assert len(refused(call("explain", tmp_path / "bomb.toml"))) < 400
    (tmp_path / "heir.toml").write_text("based_on = 'bomb.toml'")
    assert len(refused(call("explain", tmp_path / "heir.toml"))) < 400


def test_a_long_line_of_numbers_is_accepted(tmp_path):
    corners = ", ".join(f"[{0.1 * k:.1f}, {0.1 * (k * k % 7):.1f}]" for k in range(190))
    (tmp_path / "long.toml").write_text(f"x = [{corners}]")
    assert "x: unknown key" in refused(call("explain", tmp_path / "long.toml"))


TABLES_TO_REFUSE = {  # what makes them, since they are large
    "wide-names": (lambda: ",".join(f"c{k}" for k in range(2_000_000)), "more than 100 columns"),
    "wide-empty": (lambda: "," * 20_000_000, "more than 100 columns"),
    "wide-row": (lambda: "y,z,radius\n" + "1," * 10_000_000, "more than 100 columns"),
    "long": (lambda: "y,z,radius\n" + "0,0,1\n" * 2_000_000, "more than 100000 rows"),
    "long-cell": (lambda: "y,z,radius\n" + "1" * 20_000_000 + ",0,0", "cannot be read"),
    "quoted-cell": (lambda: 'y,z,radius\n"' + "x" * 20_000_000 + '",0,0', "cannot be read"),
    "large": (lambda: "#" * 33_000_000, "too large for a table"),
    "comments": (lambda: "#\n" * 4_000_000, "empty"),
}


@pytest.mark.parametrize("name", TABLES_TO_REFUSE)
def test_a_table_that_is_too_large_is_refused(tmp_path, name, little_memory):  # noqa: F811
    content, words = TABLES_TO_REFUSE[name]
    (tmp_path / "grains.csv").write_text(content())
    (tmp_path / "preset.toml").write_text(LISTED)
    said = refused(call("explain", tmp_path / "preset.toml"))
    assert words in said and len(said) < 400


SECRET = "a-secret-word-of-another-file\nand,another,one\n" * 40
PATHS = ["../secret.txt", "secret-link", "/{at}/secret.txt", "./x/../../secret.txt"]


@pytest.mark.parametrize("path", PATHS)
@pytest.mark.parametrize("key", ["based_on", "grains.bed", "motion.history.file", "shapes.x.contour"])
def test_messages_show_little_of_another_file(tmp_path, key, path):
    home = tmp_path / "presets"
    (home / "x").mkdir(parents=True)
    (tmp_path / "secret.txt").write_text(SECRET)
    (home / "secret-link").symlink_to(tmp_path / "secret.txt")
    path = path.replace("{at}", str(tmp_path))
    text = f'{key} = "{path}"\n' + ("" if key == "based_on" else 'based_on = "tilting/quick"\n')
    (home / "preset.toml").write_text(text)
    said = refused(call("explain", home / "preset.toml"))
    assert len(said) < 400 and said.count("secret-word") <= 1 and "another,one" not in said


@pytest.mark.parametrize("device", ["/dev/zero", "/dev/urandom", "/proc/self/mem", "/proc/kmsg", "/dev/stdin"])
def test_devices_are_refused_as_files(tmp_path, device):
    (tmp_path / "preset.toml").write_text(f'based_on = "{device}"')
    refused(call("explain", tmp_path / "preset.toml"))
    (tmp_path / "bed.toml").write_text(LISTED.replace("grains.csv", device))
    refused(call("explain", tmp_path / "bed.toml"))


NAMES = ["..toml", "...toml", ".toml", "....toml"]


@pytest.mark.parametrize("name", NAMES)
def test_the_name_of_a_preset_cannot_lead_out_of_a_folder(tmp_path, name, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / name).write_text('based_on = "tilting/quick"')
    loaded = load(str(tmp_path / name))
    assert loaded.name.strip(".") and "/" not in loaded.name
