"""Arrays that a bench keeps: taken again only from the same code on the same machine."""

import numpy as np

from benchmarks import remembered as module
from benchmarks.remembered import remembered


def test_arrays_of_other_code_are_made_anew(tmp_path, monkeypatch):
    path, made = tmp_path / "sub" / "a.npz", []

    def make():
        made.append(len(made))
        return {"x": np.full(2, float(made[-1]))}

    first, again = remembered(path, "x", make), remembered(path, "x", make)
    assert first.keys() == again.keys() == {"x"} and first["x"].tolist() == again["x"].tolist() == [0.0, 0.0]
    monkeypatch.setattr(module, "code", lambda: "other code")
    assert remembered(path, "x", make)["x"].tolist() == [1.0, 1.0]
    np.savez(path, x=np.zeros(2))  # as earlier versions left it
    assert remembered(path, "x", make)["x"].tolist() == [2.0, 2.0]
