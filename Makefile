# Lumen. `make run` shows it, `make test` proves it; both set themselves up and need no root.

PYTHON ?= python3
BIN := .venv/bin
# Runs what uses the Debian packages that were unpacked where nobody is root.
WITH := sh scripts/with_packages.sh
STORY ?= visitor
SPEED ?= 4
TESTS ?= tests
# The marks of the tests of `make rest` that are run: all, or for example "broker", "physics and not broker".
ONLY ?=
# What the tests of `make test` take of the processor, to print how long they will take [s].
CPU := 500
# The same for the rest, which waits half of its time for processes, brokers and the browser.
REST := 2200
WORKERS ?= $(shell getconf _NPROCESSORS_ONLN)
PYTEST = $(WITH) $(BIN)/python -m pytest -n $(WORKERS) --dist loadgroup --no-loadscope-reorder
LEFT_OUT := soak or slow or broker or physics or npm

# Where Python may not write what it has compiled, each of the processes that tests start compiles everything again.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: help run setup quick test tested test-all rest soak broker check docs packages clean

help:
	@echo "make run      a visitor meets the simulated robot (STORY=visitor, SPEED=1|4|max)"
	@echo "make setup    what the tests need: .venv, Debian packages, what npm has"
	@echo "make quick    for a minute the tests nearest to what changed, without the long ones (TESTS=tests/FOLDER)"
	@echo "make test     what proves Lumen: style, types, all that is deterministic, and one broker, browser and physics"
	@echo "make test-all every test; make rest: those that make test leaves out (ONLY=broker: those with that mark)"
	@echo "make broker   a private RabbitMQ on loopback, installed where it is missing"
	@echo "make check    style, types and floors only"
	@echo "make docs     the documentation as a site, build/docs/index.html; what it shows is run and compared"
	@echo "make soak     the randomised tests with all their examples: hours"
	@echo "make packages the Debian packages among that, where they are missing"
	@echo "make clean    delete what all these made"

run: .venv/run
	@$(BIN)/lumen run --story $(STORY) --speed $(SPEED)

setup: .venv/test packages
	@$(WITH) $(BIN)/python scripts/fetch.py

quick: .venv/test
	@$(BIN)/python scripts/nearest.py $(TESTS) | xargs $(BIN)/python -m pytest -n 2 --dist loadfile \
		-p tests.time_budget --begin-within 34 --no-loadscope-reorder --hypothesis-profile quick --cpu-limit 1 -m "not ($(LEFT_OUT))"

# The checks and the tests side by side: the checks use one core.
test: setup
	@$(MAKE) --no-print-directory -j 2 check tested

tested:
	@env -u LUMEN_MODEL $(BIN)/lumen lint --strict
	@$(PYTEST) -m "not soak" --suite test --expect-cpu $(CPU)

test-all: test rest

rest: setup
	@$(PYTEST) -m "not soak$(if $(ONLY), and ($(ONLY)))" --suite rest $(if $(ONLY),,--expect-cpu $(REST))

soak: setup check
	@$(PYTEST) -m soak --timeout 0 -p tests.soaking

broker: .venv/test
	@echo rabbitmq-server | sh scripts/packages.sh /dev/stdin
	@$(WITH) $(BIN)/python -m tests.rabbitmq

check: .venv/test
	@$(WITH) sh scripts/check.sh

docs: .venv/docs
	@NO_MKDOCS_2_WARNING=1 $(BIN)/python -m mkdocs build --strict
	@$(BIN)/python scripts/documented.py
	@echo "open build/docs/index.html"

packages:
	@sh scripts/packages.sh packages.txt

.venv/run: locks/core.txt locks/run.txt pyproject.toml
	@PYTHON="$(PYTHON)" sh scripts/set_up.sh run

.venv/test: .venv/run locks/test.txt
	@sh scripts/set_up.sh test

.venv/docs: .venv/test locks/docs.txt
	@sh scripts/set_up.sh docs

clean:
	rm -rf .venv .cache build .lumen .pytest_cache .mypy_cache .ruff_cache .import_linter_cache
