"""Speed against accuracy on the machine at hand: `make benchmark`, into results/benchmarks/."""
