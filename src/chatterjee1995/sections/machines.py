"""The section on machines in SI units, for which dampers are designed. It is not in the paper."""

from chatterjee1995.sections.records import Kind, Table, stage
from chatterjee1995.sections.system import too_many
from impact_damper.command import machine_file
from impact_damper.model.machine import MOUNT


class Machine(machine_file.MachineEntry):
    """Machines for which dampers are designed. Values are SI numbers, or texts with units."""

    def contradictions(self, path, config):
        yield from super().contradictions(path, config)
        yield from too_many(path, self, self.counts)

    @stage(
        "impact_damper.design.design_damper:design_damper",
        "A damper for the machine {name}",
        priority=1,
        paper=False,
        page=True,
    )
    def machines(self, config) -> dict:
        damper, ball = self.damper.values(), self.contact.values()
        stiffness = damper.pop("contact_stiffness", None)
        mount = {key: damper.pop(key) for key in MOUNT if key in damper}
        effort = {"frequencies": self.band.points, "candidates": self.candidates}
        effort |= {"starts": self.starts, "seed": config.seed} | config.settling.job()
        return (
            {"system": {"Machine": self.machine.values()}}
            | damper
            | {
                "contact": {"HertzContact": ball} if ball else stiffness,
                "mount": mount or None,
                "band": [self.band.first, self.band.last],
                "share": self.share,
                "displacement_limit": self.displacement_limit,
                "tolerances": self.tolerances.values(),
                "absorber": self.absorber.values() or None,
                "effort": {"Effort": effort},
            }
        )


SECTIONS = {"machines": Machine}
KINDS = (Kind("machines", "machines", "impact_damper.plot.machine_figures", ("machines",)),)
TABLES = (Table("machines", "machines", "machines", ("machines",)),)
