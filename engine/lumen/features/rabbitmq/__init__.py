"""A bus through a RabbitMQ broker.

    amqp.py           the bus, made of the files below

How RabbitMQ is used, from the inside out:

    broker.py         where a broker is, and in one line why it can't be used
    queues.py         which queue a route has, and its bounds
    declarer.py       declares queues, binds and deletes them
    stream_reader.py  a stream of RabbitMQ, read on from where it was left
    subscriptions.py  who has subscribed, and what is delivered to whom
    outbox.py         what waits to be sent: bounded
    packing.py        images and joints as bytes
    intake.py         what of all that comes is taken, held back or dropped, and counted
    connection.py     a connection that belongs to one thread, and is opened again when it is lost
    properties.py     what AMQP says of a message, whatever it says
    wire.py           pika's connection, which writes and reads messages itself
    asked_channel.py  a channel of its own for what the broker is asked, and may refuse
    poll_loop.py      the loop that pika's connection lives in: waiting apart from what is done then
    polled.py         pika's asynchronous connection, driven by that thread, and lent to others while it waits
    publisher.py      the connection that sends, on the thread of whoever publishes, and hears what the broker has
    consumer.py       the connection that receives
    dispatcher.py     the thread that runs handlers, one at a time
    transport.py      a publisher, a consumer and a dispatcher; routes of stops have one of their own
    probe.py          what a broker lets us do, for `lumen doctor`
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
