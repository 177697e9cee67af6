"""A bus through a RabbitMQ broker.

    amqp.py           the bus, made of the files below

The use of RabbitMQ, from the inside out:

    broker.py         the address of a broker, and one-line reasons why it can't be used
    queues.py         the queue of each route, and its bounds
    declarer.py       declares queues, binds and deletes them
    stream_reader.py  reads a RabbitMQ stream from where the last reading ended
    subscriptions.py  the subscriptions, and their deliveries
    outbox.py         messages that wait to be sent: bounded
    packing.py        images and joints as bytes
    intake.py         accepts, holds back or drops deliveries, and counts them
    connection.py     a connection that belongs to one thread and reconnects when it is lost
    properties.py     reads AMQP's properties of a message, whatever they contain
    wire.py           pika's connection with its own, faster writing and reading of messages
    asked_channel.py  a separate channel for requests that the broker may refuse
    poll_loop.py      the event loop of pika's connection, with waiting apart from handling
    polled.py         pika's asynchronous connection, driven by that thread and lent to others while it waits
    publisher.py      the sending connection, used by the publishing thread; tracks confirmations
    consumer.py       the receiving connection
    dispatcher.py     the thread that runs handlers, one at a time
    transport.py      a publisher, a consumer and a dispatcher; routes of stops have one of their own
    probe.py          the permissions and state of a broker, for `lumen doctor`
"""

from lumen.feature import BusRow, Feature

_AMQP = BusRow(
    "lumen.features.rabbitmq.amqp:AmqpBus",
    ("amqp://HOST",),
    example="amqp://user:password@host/",
    probe="lumen.features.rabbitmq.probe:BrokerProbe",
    stream="lumen.features.rabbitmq.stream_reader:read_stream",
    side_queues="lumen.dead and lumen.nowhere",
)

FEATURE = Feature(name="rabbitmq", buses={"amqp": _AMQP, "amqps": _AMQP._replace(forms=("amqps://HOST",), example="")})
