"""A module in Python: greets whoever comes near, in 20 lines and with nothing but pika.

LUMEN_BUS=amqp://NAME:PASSWORD@HOST/ python greeter.py
"""

import json
import os
import sys

import pika

try:
    channel = pika.BlockingConnection(pika.URLParameters(os.environ["LUMEN_BUS"])).channel()
    mine = channel.queue_declare("", exclusive=True).method.queue
    channel.queue_bind(mine, "amq.topic", "avatar.NAO.data.sonar")
    answers = channel.queue_declare("", exclusive=True).method.queue
    near = False
    print("listening", flush=True)
    for _, _, body in channel.consume(mine, auto_ack=True):
        sonar = json.loads(body)
        was, near = near, min(sonar["leftSensor"], sonar["rightSensor"]) < 0.8
        if near and not was:
            say = {"type": "texttospeech", "method": "say", "parameter": {"text": "Hello there!"}}
            wanted = pika.BasicProperties(reply_to=answers, content_type="application/json")
            channel.basic_publish("amq.topic", "avatar.NAO.command", json.dumps(say).encode(), wanted)
except (pika.exceptions.AMQPError, OSError) as error:
    sys.exit(f"greeter: the broker can't be used: {error!r}")
