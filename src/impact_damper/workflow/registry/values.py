"""Values from the configuration that are parameters of many jobs."""

from impact_damper.system.parameters import Damper, Oscillator, pick


def oscillator(config, name) -> dict:
    """Arguments of `Oscillator` for an entry of `oscillators`."""
    return pick(Oscillator, config["oscillators"][name])


def damper(config, entry) -> dict | None:
    """Arguments of `Damper` for an entry, or None if it has no damper."""
    if "mass_ratio" not in entry:
        return None
    return {"contact_stiffness": config["contact_stiffness"]} | pick(Damper, entry)


def settling(config) -> dict:
    """Arguments of `Settling`; the tolerance is taken from the test case `settling.scene`."""
    given = {key: value for key, value in config["settling"].items() if key != "scene"}
    return given | {"tolerance": config["scenes"][config["settling"]["scene"]]["tolerance"]}


def search(config, starts) -> dict:
    """Arguments of a search: number of starts, from the given key of `search`, radius and seed."""
    given = config["search"]
    return {"starts": given[starts], "radius": given["radius"], "seed": config["seed"]}


def grid(span, points) -> list:
    """Arguments of `numpy.linspace`."""
    return [span["first"], span["last"], points]


def system(config, entry) -> dict:
    """Parameters of the model: the oscillator and the damper of an entry."""
    return {
        "oscillator": oscillator(config, entry["oscillator"]),
        "damper": damper(config, entry),
    }


def frequencies(config, entry, points) -> list:
    """Arguments of `numpy.linspace` for the range of frequencies of an entry's oscillator."""
    span = config["oscillators"][entry["oscillator"]]["frequencies"]
    return grid(span, config["points"][points])


def axis(given) -> list:
    """Arguments of `numpy.linspace` or `numpy.geomspace` for a number or a range with `points`."""
    return grid(given, given["points"]) if isinstance(given, dict) else [given, given, 1]
