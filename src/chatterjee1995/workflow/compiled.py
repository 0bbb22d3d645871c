"""The marker file of compiled kernels (functions compiled by numba)."""

from impact_damper.kernel.sources import ROOT, kernel_digest


def compiled_kernels(orders) -> str:
    """Return the text of the marker file: digest of the sources, and orders of Taylor series."""
    kernels = [path for path in ROOT.rglob("*.py") if "impact_damper.kernel." in path.read_text()]
    return f"{kernel_digest(*kernels)} {orders}\n"
