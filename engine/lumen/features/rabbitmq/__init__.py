"""A bus through a RabbitMQ broker.

    amqp.py           the bus, built from the files below

The use of RabbitMQ, from the inside out:

    broker.py         a broker's address, and one-line reasons why the broker can't be used
    queues.py         the queue of each route, and its limits
    declarer.py       declares queues, binds and deletes them
    stream_reader.py  reads a RabbitMQ stream from a given offset
    subscriptions.py  the subscriptions, and their deliveries
    outbox.py         a bounded queue of messages to be sent
    packing.py        images and joints as bytes
    intake.py         accepts, holds back or drops deliveries, and counts them
    connection.py     a connection that belongs to one thread and reconnects when it is lost
    properties.py     reads a message's AMQP properties, valid or not
    wire.py           pika's connection with its own, faster writing and reading of messages
    asked_channel.py  a separate channel for requests that the broker may refuse
    poll_loop.py      the event loop of pika's connection, with separate waiting and handling
    polled.py         pika's asynchronous connection, driven by its own thread and lent to others during waits
    publisher.py      the sending connection, used by the publishing thread; tracks confirmations
    consumer.py       the receiving connection
    dispatcher.py     the thread that runs handlers, one at a time
    transport.py      a publisher, a consumer and a dispatcher; stops use a separate transport
    probe.py          a broker's permissions and state, for `lumen doctor`
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
