"""Robots behind `lumen.ports.Robot`, and what they share.

    remote/               a robot in another process, on the bus
    recording.py          performs nothing and remembers everything: for stories and tests
    none.py               no robot: every command is refused
    bounded_robot.py      a robot that a user wrote, given only commands that its body can perform
    checked_robot.py      such a robot, whose returned values are of the declared types

How a command is performed:

    command_table.py      the properties of each command, one row for each
    command_checks.py     reads the parameters of commands, and refuses values that a body cannot perform
    command_bounds.py     limits commands to the angles and speeds of the body
    joint_ways.py         the ways of joints to the posture that a motion begins in, and back after a cancel
    executor.py           a command waits until its parts of the body are free, then runs until it is done
    person_hold.py        a robot that a person stopped does not move until a person releases it
    hazards.py            reasons why a robot must not walk now
    cues.py               the words, sounds and skills of a motion, raised at their times
    gesture_player.py     the gestures that accompany what it says
    joint_offsets.py      moves joints smoothly to the offsets of life and gestures
    life_layer.py         small movements of an idle robot, beneath all commands
    silent_recording.py   recordings of silence, for a simulated hall
    links.py              the poses and shapes of a robot's links: a feature computes both
    skill_runner.py       verbs of features: their code runs in threads that block nothing

A robot on the bus:

    server.py             Lumen Server: the senses out, the commands in
    robot_routes.py       the routing keys between a robot and its brain
    command_codec.py      commands as JSON: those of 2015, and those that Lumen added
    command_parameters.py their parameters, also in the spellings of 2015
    motion_codec.py       motions as JSON
    sense_codec.py        the five senses as JSON
    sense_publisher.py    the thread of a sense
    command_receiver.py   commands from the bus, until they are over
    command_queries.py    queries about them, and about a robot that a person stopped
    command_reports.py    their states, for the sender and all other subscribers
    deduplication_log.py  the commands that have begun, for the process that follows a killed one
"""
