"""Robots behind `lumen.ports.Robot`, and what they share.

    remote/               a robot in another process, on the bus
    recording.py          performs nothing and remembers everything: for stories and tests
    none.py               no robot: every command is refused
    bounded_robot.py      a robot that a user wrote, given only commands that its body can perform
    checked_robot.py      such a robot, whose returned values are of the declared types

How a command is performed:

    command_table.py      what every robot knows of each command: a row for each
    command_checks.py     how it is read from the bus, and which values a body can perform
    command_bounds.py     each command is brought within the limits and speeds of the body
    joint_ways.py         to the posture that a motion begins in, and back after a cancel
    executor.py           a command waits until its parts are free, then runs until it is done
    person_hold.py        a robot that a person stopped moves for nobody, until a person lets it
    hazards.py            why a robot must not walk now
    cues.py               the words and sounds of a motion, as their times come
    gesture_player.py     the gestures that accompany what it says
    joint_offsets.py      how joints go to where life and gestures want them
    life_layer.py         what the robot does of its own accord, beneath all commands
    silent_recording.py   a recording where nobody makes a sound
    links.py              where the links of a robot are, and what they look like: a feature computes both
    skill_runner.py       verbs of features: their code runs in threads that nothing waits for

A robot on the bus:

    server.py             Lumen Server: the senses out, the commands in
    robot_routes.py       under which keys a robot and its brain talk
    command_codec.py      commands as JSON, as those of 2015 and ours
    command_parameters.py their parameters, in the ways that 2015's modules wrote them
    motion_codec.py       motions as JSON
    sense_codec.py        the five senses as JSON
    sense_publisher.py    the thread of a sense
    command_receiver.py   commands from the bus, until they are over
    command_queries.py    what is asked about them, and about a robot that is stopped
    command_reports.py    how they stand, for the sender and everybody who watches
    deduplication_log.py  which commands were begun, for the process that comes after a killed one
"""
