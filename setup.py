"""What pyproject.toml cannot say of the wheel: the posters in the gallery go into it, beside the presets."""

from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py

GALLERY, PLACE = Path("renders/gallery/presets"), Path("presets/posters")  # lab/base/data.py finds them in both


class WithPosters(build_py):
    """Python files, their data, and the posters: copied when a wheel is built, named for a source distribution."""

    def run(self) -> None:
        super().run()
        if self.editable_mode:
            return  # the source has them
        place = Path(self.build_lib) / PLACE
        place.mkdir(parents=True, exist_ok=True)
        for poster in posters():
            self.copy_file(str(poster), str(place / poster.name))

    def get_source_files(self) -> list[str]:
        return [*super().get_source_files(), *map(str, posters())]


def posters() -> list[Path]:
    """The posters that the gallery keeps, GROUP-NAME.webp."""
    return sorted(GALLERY.glob("*-*.webp"))


setup(cmdclass={"build_py": WithPosters})
