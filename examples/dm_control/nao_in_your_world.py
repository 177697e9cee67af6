"""A NAO in a dm_control world of your own: it stands for two seconds.

python examples/dm_control/nao_in_your_world.py
"""

from pathlib import Path

from dm_control import mjcf
from dm_control.locomotion.arenas import floors

import lumen
from lumen.features.simulation.entity import Nao

HERE = Path(__file__).parents[2]

arena = floors.Floor()
nao = Nao(lumen.load(HERE).body, HERE / "models")
arena.add_free_entity(nao)

physics = mjcf.Physics.from_mjcf_model(arena.mjcf_model)
nao.take(physics, "Crouch")
while physics.time() < 2.0:
    physics.step()
print(f"its torso is {physics.bind(nao.mjcf_model.find('body', 'Torso')).xpos[2]:.2f} m above the ground")  # noqa: T201
