from lumen.skills import skill


@skill
def spray(call, duration, nozzle):
    print("spraying with the", nozzle, "nozzle")
    if call.wait(duration):
        return {"litres": 0.2}
