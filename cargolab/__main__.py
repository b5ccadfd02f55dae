"""The command `cargolab`, also as `python -m cargolab`."""

import sys

from cargolab._hidden import sentence


def main() -> None:
    """Run the command line and exit; where a user's own file hides the lab, say which."""
    if hidden := sentence():
        print(f"cargolab: {hidden}", file=sys.stderr)
        sys.exit(2)
    from lab.cli import main as commands

    commands(prog_name="cargolab")


if __name__ == "__main__":
    main()
