"""Tests for robots of your own: `pytest --lumen-robot package:Class`, or a NAME for drivers/NAME.py of the project.

    plugin.py         the plugin of pytest, with its options and the fixtures
    robot_promises.py     the tests: one for each promise that a robot keeps (`lumen.ports.Robot`)
    trial.py          a robot under test, for which time passes

A robot that breaks a promise fails the test with a sentence. No other module of Lumen imports this package.
"""
