"""Speed and accuracy of the kernel and of other integrators on this computer.

`make benchmark` writes tables and charts into results/benchmarks/. The kernel is this package's
compiled integrator.
"""
