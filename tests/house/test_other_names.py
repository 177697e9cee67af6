"""No joint or link of NAO is named in the engine: bodies are data, and skills ask for roles."""

import re
import xml.etree.ElementTree as ET

import lumen
from tests import ROOT
from tests.scanning import matching

ENGINE = ROOT / "engine/lumen"
MAY = ("features/naoqi/", "features/formats_motion/")
"""Code that speaks with NAOqi, or reads files made for it."""


def test_no_joint_or_link_of_nao_is_named_in_the_engine() -> None:
    body = lumen.load(ROOT).body
    links = {element.get("name", "") for element in ET.parse(ROOT / "models/nao.xml").iter("body")} - {""}
    sensors = body.roles.sensors
    sites = {*body.roles.soles.values(), *sensors.sonar.values(), *sum(sensors.force.values(), ())}
    names = {*body.joints, *links, *sites, body.roles.eyes.camera}
    assert len(names) > 40
    named = re.compile(rf"\b({'|'.join(sorted(names))})\b")
    found = [
        f"{where}:{number}: {match[0]}"
        for file in matching(ENGINE, "**/*.py")
        if not (where := file.relative_to(ENGINE).as_posix()).startswith(MAY)
        for number, line in enumerate(file.read_text("utf-8").splitlines(), 1)
        if (match := named.search(line))
    ]
    assert not found, "ask for a role (language/roles.py) in place of a name"
