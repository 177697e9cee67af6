"""A bus through a RabbitMQ broker."""

from lumen.feature import BusRow, Feature

_OPEN = "lumen.features.rabbitmq.amqp:AmqpBus"

FEATURE = Feature(
    name="rabbitmq",
    buses={
        "amqp": BusRow(_OPEN, ("amqp://HOST",), example="amqp://user:password@host/", rabbitmq=True),
        "amqps": BusRow(_OPEN, ("amqps://HOST",), rabbitmq=True),
    },
)
