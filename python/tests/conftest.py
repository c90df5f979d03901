import pathlib

import pytest

import cloud2csg

ROOT = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def root():
    """The folder of the sources."""
    return ROOT


@pytest.fixture(scope="session")
def plate():
    """A plate with a boss and a bore through both."""
    primitives = [
        cloud2csg.Primitive("plate", cloud2csg.Box((4, 3, 1))),
        cloud2csg.Primitive("boss", cloud2csg.Cylinder(1, 2), position=(0.5, 0, 1)),
        cloud2csg.Primitive("bore", cloud2csg.Cylinder(0.5, 6), position=(0.5, 0, 0)),
    ]
    return cloud2csg.Model(primitives, "(plate | boss) - bore")


@pytest.fixture(scope="session")
def m0():
    return cloud2csg.Model.read(ROOT / "data/models/m0.json")


@pytest.fixture
def endless():
    """Options of a search that does not end by itself."""
    return cloud2csg.ExtractOptions(strategy="baseline", search=cloud2csg.GaOptions(
        idle_generations=1_000_000_000, generation_limit=1_000_000_000, listing_limit=0, trust=0))
