"""Films that find their event: its time, slow motion around it, the verdict at the end, animated pictures, moments."""

import numpy as np
import pytest
from PIL import Image

from lab.base.errors import LabError
from lab.paint.cargo.looks import Stowage, looks, of_density
from lab.paint.edit.animation import write_animation
from lab.paint.edit.event import find_event, telling_moments
from lab.paint.edit.timeline import HELD, RATE, SLOWER, hero_timeline
from lab.paint.film import Film, choose_beds, choose_look
from lab.paint.footage import open_footage
from lab.paint.scene.moves import on_the_way
from lab.paint.video import contact_sheet, render_recording, telling_time
from lab.preset.sections.video import CARGOES
from solvers.machine.runtime import initialise
from tests.oracles.pools import standing_wave
from tests.oracles.synthetic import box, frame, recorder, sample

SLIDES, LASTS, WAY = 6.0, 10.0, 0.02  # s, s, m


@pytest.fixture(scope="module")
def slide(tmp_path_factory):
    """A tank that tilts by 4 deg/s; its grains slide within 0.3 s about `SLIDES`, at the rate of a cosine bell."""
    folder = tmp_path_factory.mktemp("slide")

    def moved(now):
        return WAY * 0.5 * (1.0 + np.sin(np.pi * np.clip((now - SLIDES) / 0.3, -0.5, 0.5)))

    with recorder(folder, outline=box()) as writer:
        for now in np.arange(0.0, LASTS + 1e-9, 0.02):
            pose = np.array([[0.0, 0.0, np.radians(4.0 * now)]])
            writer.sample(sample(now, pose=pose, centre_of_mass=np.array([[-moved(now), 0.0]])))
            if round(now / 0.02) % 5 == 0:
                place = np.array([[[0.02 * k - moved(now), 0.01] for k in range(4)]])
                writer.frame(frame(now, pose=pose, position=place))
    return folder


def test_an_avalanche_is_found_where_the_bed_slides(slide):
    with open_footage(slide) as footage:
        (bed,) = choose_beds(footage)
        event = find_event(bed)
        assert event.time == pytest.approx(SLIDES, abs=0.06)
        assert event.says.startswith("Avalanche at 2") and event.says.endswith("s") and "°" in event.says


def test_the_pace_is_slow_about_the_event_and_even_elsewhere(slide):
    with open_footage(slide) as footage:
        (bed,) = choose_beds(footage)
        timeline = hero_timeline(bed, 1.0)
    paces = np.diff(timeline.time) * RATE
    running = paces[: len(timeline.time) - 1 - timeline.held - 1]
    assert running.max() == pytest.approx(1.0) and running.min() == pytest.approx(1.0 / SLOWER)
    slow = running < 0.21
    assert slow.sum() / RATE == pytest.approx(3.0, abs=0.3)  # s of film
    assert timeline.time[:-1][: len(running)][slow].min() < SLIDES < timeline.time[:-1][: len(running)][slow].max()
    assert all(note.startswith("slow motion: 0.2") for note, late in zip(timeline.notes, slow, strict=False) if late)
    assert timeline.notes[0] == timeline.notes[-1] == ""
    assert timeline.held == round(HELD * RATE) and np.ptp(timeline.time[-timeline.held :]) == 0.0
    assert timeline.time[-1] == pytest.approx(LASTS)


def test_the_last_still_says_what_happened_and_earlier_pictures_do_not(slide):
    initialise(fields=False)
    with open_footage(slide) as footage:
        beds = choose_beds(footage)
        film = Film(beds, choose_look(footage, width=640, height=360), timeline=hero_timeline(beds[0], 1.0))
        film.picture(0)
        assert "band" not in film.written
        last = film.picture(len(film.time) - 1)
        left, top, _, bottom = film.written["band"]
        assert (last[(top + bottom) // 2, left + 3] == (190, 60, 20)).all()


def test_places_between_frames_are_exact_for_steady_acceleration():
    """x = 3 + 2 t − 5 t², recorded every 0.1 s."""

    def place(t):
        return np.array([[3.0 + 2.0 * t - 5.0 * t * t, 0.0]])

    def rate(t):
        return np.array([[2.0 - 10.0 * t, 0.0]])

    for share in (0.1, 0.5, 0.8):
        found = on_the_way(place(0.0), place(0.1), rate(0.0), rate(0.1), share, 0.1)
        np.testing.assert_allclose(found, place(0.1 * share), atol=1e-14)
    still = np.array([[1.0, 1.0]])
    np.testing.assert_array_equal(on_the_way(still, still, rate(0.0), -rate(0.0), 0.5, 0.1), still)


def test_a_funnel_is_shown_as_half_of_its_grains_have_come_down(tmp_path):
    line = np.array([[-0.02, 0.05], [-0.01, 0.02]])
    with recorder(tmp_path, parts={"left": line}) as run:
        for now in np.linspace(0.0, 4.0, 41):
            down = 0.03 * min(now / 2.0, 1.0) ** 2  # m: half of it at 1.41 s
            run.sample(sample(now, centre_of_mass=[[0.0, 0.05 - down]]))
            run.frame(frame(now, part=np.zeros((1, 1, 2))))
    assert telling_time(tmp_path) == pytest.approx(1.5, abs=0.11)


def test_moments_are_closer_together_where_more_happens(slide):
    with open_footage(slide) as footage:
        (bed,) = choose_beds(footage)
        times = telling_moments(bed, 6)
    assert times[0] == 0.0 and times[-1] == pytest.approx(LASTS) and (np.diff(times) > 0.0).all()
    assert np.diff(times).min() < 0.5 * np.diff(times).max()
    nearest = times[np.argmin(np.abs(times - SLIDES))]
    assert abs(nearest - SLIDES) < 0.3


def test_the_impact_of_water_is_the_highest_pressure_of_its_gauges():
    made = standing_wave()
    pressure = 100.0 + np.zeros((len(made.series_time), 1, len(made.water.gauges)))
    pressure[len(pressure) // 2, 0, 1] = 2345.0
    made.series["gauge_pressure"] = pressure[:, 0]
    event = find_event(made.bed)
    assert event.time == pytest.approx(made.series_time[len(pressure) // 2])
    assert "2.35 kPa" in event.says or "2.34 kPa" in event.says
    assert "P2" in event.says


@pytest.mark.parametrize("suffix", [".gif", ".webp"])
def test_animated_pictures_have_their_size_and_run_for_ever(slide, tmp_path, suffix):
    out = render_recording(slide, tmp_path / f"film{suffix}", width=320, height=180, speed=4.0)
    assert list(tmp_path.iterdir()) == [out]
    with Image.open(out) as film:
        assert film.size == (320, 180) and film.n_frames > 20 and film.info["loop"] == 0
        film.seek(film.n_frames - 1)
        film.convert("RGB")


def test_a_film_that_is_too_long_for_an_animated_picture_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr("lab.paint.edit.animation.MOST", 2)
    with pytest.raises(LabError, match="more than 2 pictures"):
        write_animation(tmp_path / "a.gif", [np.zeros((8, 8, 3), np.uint8)] * 3, 10.0)


def test_a_contact_sheet_shows_six_moments_with_their_times(slide):
    out = contact_sheet(slide, width=640, height=360)
    assert out.name == "sheet.png"
    with Image.open(out) as sheet:
        assert sheet.size == (640, 360)
        picture = np.asarray(sheet.convert("RGB")).astype(int)
    wall = (np.abs(picture - (86, 97, 110)).max(axis=2) < 6)[:, :430]
    assert wall.sum() > 500


def test_cargo_is_what_is_named_else_its_outline_else_its_density():
    assert set(looks()) == set(CARGOES)
    assert of_density(1319.0) == "acetate" and of_density(4450.0) == "iron-ore" and of_density(5.0) == "stone"
    kind, shape = np.array([0, 0, 1]), np.array([0, 1, 1])
    assert list(Stowage("coal", ("corn", None)).names(kind, shape)) == ["coal"] * 3
    mixed = Stowage(None, ("corn", None), ("acetate", "iron-ore"))
    assert list(mixed.names(kind, shape)) == ["corn", "acetate", "iron-ore"]
    assert list(mixed.names(kind, None)) == ["acetate", "acetate", "iron-ore"]


def test_named_cargo_is_painted_in_its_colour(slide):
    initialise(fields=False)
    found = {}
    with open_footage(slide) as footage:
        for cargo in ("corn", "coal"):
            film = Film(choose_beds(footage), choose_look(footage, width=640, height=360, cargo=cargo, colour="cargo"))
            (x, y), picture = film.tank_camera(0, 0).pixels(np.array([[0.04, 0.01]]))[0], film.picture(0)
            found[cargo] = picture[int(y), int(x)].astype(int)
    assert found["corn"][0] > 150 > found["corn"][2] and found["coal"].max() < 130
