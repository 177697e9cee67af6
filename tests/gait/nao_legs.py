"""The legs of the shipped robots' models, as they are read, and legs made up for tests."""

from dataclasses import replace

from lumen.features.simulation.falling_sense import MassModel
from lumen.features.simulation.leg_geometry import read_legs
from tests import ROOT
from tests.motions.making import nao

MODELS = ROOT / "models"

NAO_LEGS = read_legs(MassModel(nao(), MODELS).model, nao())

CLASSIC_LEGS = replace(
    NAO_LEGS,
    hip_ahead=0.012,
    hip_out=0.04,
    thigh=0.13,
    tibia=0.11,
    foot=0.03,
    inclination=0.0,
    shared=False,
    signs={"L": (1.0, -1.0, 1.0, -1.0, 1.0, -1.0), "R": (1.0, 1.0, -1.0, 1.0, -1.0, 1.0)},
    offsets={"L": (0.0, 0.0, -0.2, 0.3, -0.1, 0.0), "R": (0.0, 0.0, -0.2, 0.3, -0.1, 0.0)},
)
"""Hips that yaw, roll and pitch, each with its own motors; other lengths, joints that count otherwise."""
