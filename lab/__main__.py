"""`python -m lab` is `cargolab`."""

from lab.cli import main

if __name__ == "__main__":
    main(prog_name="cargolab")
