"""The force sensors under the feet: four in each, as NAO's `FSR`."""

from collections.abc import Mapping

import mujoco

from lumen.robots.simulation.model import ROBOT_PREFIX

NEWTONS_PER_KILOGRAM = 9.81
"""ALMemory counts these forces in kilograms: newtons divided by this."""

SENSED_FEET = ("LFoot", "RFoot")
SOLE_CORNERS = ("FrontLeft", "FrontRight", "RearLeft", "RearRight")


class ForceSensors:
    """Weighs what presses against each quarter of the soles, where the model has a touch sensor for it."""

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        sensors = {
            name: mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SENSOR, f"{ROBOT_PREFIX}/{sensor}")
            for name, sensor in _names()
        }
        self._places = {name: int(model.sensor_adr[id]) for name, id in sensors.items() if id >= 0}
        self._data = data

    def weigh(self) -> Mapping[str, float]:
        """What each sensor feels [kg] by ALMemory's name (`LFoot/FSR/FrontLeft`), and each foot's `TotalWeight`."""
        if not self._places:
            return {}
        felt = {
            name: float(self._data.sensordata[place]) / NEWTONS_PER_KILOGRAM for name, place in self._places.items()
        }
        total = {f"{foot}/FSR/TotalWeight": sum(felt[n] for n in felt if n.startswith(foot)) for foot in SENSED_FEET}
        return {name: round(weight, 3) for name, weight in (felt | total).items()}


def _names() -> list[tuple[str, str]]:
    """ALMemory's name of each sensor, and the one in the MJCF, where a slash means something else."""
    return [(f"{foot}/FSR/{corner}", f"{foot}{corner}") for foot in SENSED_FEET for corner in SOLE_CORNERS]
