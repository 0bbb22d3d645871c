"""The marker file of compiled kernels (functions compiled by numba)."""

from impact_damper.kernel.sources import ROOT, kernel_digest, module_file

COMPILER = module_file("chatterjee1995.workflow.compile_kernels")


def compiled_kernels(config) -> str:
    """Return the text of the marker file: digest of the sources, and orders of Taylor series."""
    kernels = [path for path in ROOT.rglob("*.py") if "impact_damper.kernel." in path.read_text()]
    return f"{kernel_digest(*kernels)} {config['comparison']['orders']}\n"
