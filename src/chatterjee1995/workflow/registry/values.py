"""Parameters that many jobs take from the configuration."""

from impact_damper.model.parameters import Damper, Oscillator, pick


def oscillator(config, name) -> dict:
    """Return the arguments of `Oscillator` for an entry of `oscillators`."""
    return pick(Oscillator, config["oscillators"][name])


def damper(config, entry) -> dict | None:
    """Return the arguments of `Damper` for an entry, or None for an entry without a damper."""
    if "mass_ratio" not in entry:
        return None
    return {"contact_stiffness": config["contact_stiffness"]} | pick(Damper, entry)


def settling(config) -> dict:
    """Return the arguments of `Settling`."""
    return config["settling"]


def search(config, starts) -> dict:
    """Return the arguments of a search: radius, seed, and the number of starts (initial states).

    `starts` is the key of the section `search` that holds this number.
    """
    given = config["search"]
    return {"starts": given[starts], "radius": given["radius"], "seed": config["seed"]}


def grid(span, points) -> list:
    """Return the arguments of `numpy.linspace` for a range with the keys `first` and `last`."""
    return [span["first"], span["last"], points]


def system(config, entry) -> dict:
    """Return the arguments of the oscillator and of the damper of an entry."""
    return {
        "oscillator": oscillator(config, entry["oscillator"]),
        "damper": damper(config, entry),
    }


def frequencies(config, entry, points) -> list:
    """Return the arguments of `numpy.linspace` for the frequencies of an entry's oscillator."""
    span = config["oscillators"][entry["oscillator"]]["frequencies"]
    return grid(span, config["points"][points])


def axis(given) -> list:
    """Return the arguments of `numpy.linspace` or `geomspace` for a number or a range.

    A range has the keys `first`, `last` and `points`.
    """
    return grid(given, given["points"]) if isinstance(given, dict) else [given, given, 1]
