"""What all tests may ask for."""

from tests.rabbitmq import broker

__all__ = ["broker"]
