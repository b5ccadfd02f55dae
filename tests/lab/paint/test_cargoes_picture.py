"""The picture of all cargoes: each bed as large as it fits, in its cargo's colour."""

import numpy as np
from PIL import Image

from lab.paint.cargoes import CELL, COLOURS, COLUMNS, EDGE, paint_cargoes
from lab.studies import gallery
from lab.studies.gallery import make_gallery
from tests.oracles.synthetic import DIAMETER, box, frame, recorder, sample


def bed(folder, size):
    """A recorded row of four grains on the floor of a tank that is `size` times as large."""
    places = np.array([[k * 2.0 * DIAMETER, DIAMETER] for k in range(4)]) * size
    settings = {"radius": np.full((1, 4), 0.5 * DIAMETER * size), "outline": size * box(0.06, 0.05)}
    with recorder(folder, **settings) as run:
        run.sample(sample(0.0))
        run.frame(frame(0.0, position=places[None]))
    return folder


def cells(path):
    """The cells of a picture, (high, wide, 3) each."""
    whole, (wide, high) = np.asarray(Image.open(path).convert("RGB")).astype(float), CELL
    rows, columns = (whole.shape[0] - EDGE) // (high + EDGE), (whole.shape[1] - EDGE) // (wide + EDGE)
    corners = [(EDGE + j * (high + EDGE), EDGE + i * (wide + EDGE)) for j in range(rows) for i in range(columns)]
    return [whole[top : top + high, left : left + wide] for top, left in corners]


def test_each_bed_has_its_colour_and_the_same_size_in_the_picture(tmp_path):
    beds = {"corn": bed(tmp_path / "a", 1.0), "beans": bed(tmp_path / "b", 0.05), "husks": bed(tmp_path / "c", 1.0)}
    found = cells(paint_cargoes(beds, tmp_path / "picture.png"))
    assert len(found) == 2 * COLUMNS
    painted = [
        np.abs(cell - np.array(COLOURS[name])).max(axis=2) < 60 for name, cell in zip(beds, found[:2], strict=False)
    ]
    assert painted[0].sum() > 1500
    assert painted[1].sum() > 0.7 * painted[0].sum()
    assert np.all(found[3] == found[3][0, 0])  # nothing where there is no fourth


def test_the_gallery_shows_the_cargoes_that_were_run(tmp_path, monkeypatch):
    monkeypatch.setattr(gallery, "_show", lambda name, out, beds, progress: bed(out / "runs" / name, 1.0))
    text = make_gallery(["shapes/wheat"], tmp_path, quiet=True).read_text()
    assert f'src="{gallery.CARGOES}"' in text
    assert len(cells(tmp_path / "runs" / "cargoes.png")) == COLUMNS
    with Image.open(tmp_path / gallery.CARGOES) as card:
        assert card.width == gallery.WIDE[0]
