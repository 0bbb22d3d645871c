"""Machines in SI units, which the paper does not have, and the dampers designed for them."""

from chatterjee1995.sections.records import Kind, Table, stage
from chatterjee1995.sections.system import too_many
from impact_damper.command import machine_entry

# Names of the figures of a machine's page, the keys of `plot.pages.machine.FIGURES`.
PAGE = (
    "drawing",
    "response",
    "transients",
    "cliff",
    "tolerances",
    "forces",
    "dampers",
    "competitors",
    "masses",
)


class Machine(machine_entry.MachineEntry):
    """Machines for which a damper is designed, in SI units: numbers, or texts with units."""

    def contradictions(self, path, config):
        yield from super().contradictions(path, config)
        yield from too_many(path, self, self.counts)

    @stage(
        "impact_damper.design.design_damper:design_damper",
        "A damper for the machine {name}",
        priority=1,
        paper=False,
        page=PAGE,
    )
    def machines(self, config) -> dict:
        ball = self.contact.values()
        keys = ("candidates", "starts", "share", "displacement_limit")
        return (
            {"system": {"Machine": self.machine.values()}}
            | self.damper.values()
            | {key: getattr(self, key) for key in keys}
            | {
                "contact": {"HertzContact": ball} if ball else None,
                "band": [self.band.first, self.band.last],
                "frequencies": self.band.points,
                "tolerances": self.tolerances.values(),
                "seed": config.seed,
            }
            | config.settling.job()
        )


SECTIONS = {"machines": Machine}
KINDS = (
    Kind(
        "machines",
        "machines",
        "impact_damper.plot.machine_figures.overview",
        ("machines",),
        named=True,
    ),
)
TABLES = (Table("machines", "machines", "machines", ("machines",)),)
