"""Remarks in the conclusion of a design on the excitation and on the restitution of the walls.

The quiet orbit is the symmetric periodic motion for which a damper is designed. The excitation is
the amplitude of the force, or what causes it, as a multiple of the nominal value.
"""

import numpy as np

from impact_damper.data.sweeps import known_range, stable_range
from impact_damper.design.restitutions import best_of
from impact_damper.theory.contact_law import contact

# In the model the dashpot of a wall may pull the loose mass at the end of a contact. A remark is
# made if the same wall without pull has a restitution that is larger by more than this fraction.
EXCESS = 0.1
# A range of excitations is called narrow if one of its ends differs from 1 by less than CLOSE.
CLOSE = 0.1
NARROW = "This range is narrow: a small change of the excitation leaves it. "


def excitations(data) -> str:
    """Return sentences on the excitations between which the quiet orbit is stable."""
    here = stable_range(data, "force")
    if not here:
        return ""
    ends = data["stability_force_by_frequency"].values
    frequency = f"{float(data['branch_frequency']):.4g} Hz"
    if np.isnan(ends).any():
        return (
            f"At {frequency} the quiet orbit is stable from {here} times the nominal excitation, "
            "but at other frequencies of the band it is not stable at the nominal excitation, or "
            "not known."
        )
    inner = np.array([ends[:, 0].max(), ends[:, 1].min()])
    over = known_range(inner, inner == data["force_share"].values[[0, -1]])
    local = "" if over == here else f" (at {frequency} from {here} times)"
    return (
        f"Over the whole band the quiet orbit is stable from {over} times the nominal excitation"
        f"{local}. {NARROW * bool(min(1 - inner[0], inner[1] - 1) < CLOSE)}"
        "For excitations outside this range see the map of excitations, which has few starts."
    )


def tried_restitutions(data) -> str:
    """Return sentences on the best restitution, if the user left it free within a range."""
    if "tried_restitution" not in data:
        return ""
    values = data["tried_restitution"].values
    *others, last = (f"{value:.3g}" for value in values)
    k = best_of(data["tried_displacement"].values, data["tried_choice"].values)
    text = (
        f"Of the restitutions {', '.join(others)} and {last}, each with its best gap, "
        f"{values[k]:.3g} is best, by a comparison with few starts."
    )
    if k in (0, len(values) - 1):
        end, way = ("lower", "lower") if k == 0 else ("upper", "higher")
        text += (
            f" This is the {end} end of the range given: a {way} restitution was not tried and may "
            "be better."
        )
    return text


def pulling_walls(restitution) -> str:
    """Return a sentence on the model of contact at a low restitution."""
    real = contact(restitution, 0.0, "no_tension").departure
    if real <= (1 + EXCESS) * restitution:
        return ""
    return (
        f"At so low a restitution the model of the walls matters: the dashpot for a "
        f"restitution of {restitution:.3g} pulls the loose mass at the end of a contact. A wall "
        f"with this dashpot that cannot pull has a restitution of {real:.2g}. A drop test shows "
        "the restitution of a real wall."
    )
