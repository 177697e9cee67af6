"""The identity that a bus derives from a foreign message's properties, valid or not."""

import math
import time

import pika
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lumen.bus import connect
from lumen.bus.identities import MAX_IDENTITY_BYTES, believed
from tests.rabbitmq import RabbitMQ
from tests.waiting import Collector

ANYTHING = st.one_of(st.none(), st.integers(), st.floats(), st.text(), st.lists(st.text()), st.binary())


@given(ANYTHING, ANYTHING, ANYTHING, ANYTHING)
def test_whatever_is_said_becomes_an_identity_that_can_be_sent_on(
    id: object, sender: object, when: object, cause: object
) -> None:
    found = believed(id, sender, when, cause)
    assert found.id
    for text in (found.id, found.sender, found.cause):
        assert len(text.encode()) <= MAX_IDENTITY_BYTES
        assert text.isprintable()
    assert 0 < found.time < math.inf


@pytest.mark.broker
@pytest.mark.usefixtures("patient_bus")
def test_a_foreign_message_keeps_what_it_says_and_gets_what_it_does_not(broker: RabbitMQ) -> None:
    bus, seen = connect(broker.url), Collector()
    bus.subscribe("lumen.a", seen)
    connection = pika.BlockingConnection(pika.URLParameters(broker.url))
    channel = connection.channel()
    named = pika.BasicProperties(message_id="theirs", app_id="speech", timestamp=1_425_000_000)
    hostile = pika.BasicProperties(message_id="\x1b[2J", app_id="a\nb", timestamp=2**63)
    for properties in (named, None, hostile):
        channel.basic_publish("amq.topic", "lumen.a", b"1", properties)
    seen.wait(3)
    connection.close()
    bus.close()
    first, second, third = seen.messages
    assert first[4:7] == ("theirs", "speech", 1_425_000_000.0)
    for message in (second, third):
        assert message.id
        assert message.sender == ""
        assert abs(message.time - time.time()) < 600
