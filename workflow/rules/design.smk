rule harmonic_balance:
    input:
        code=code("harmonic_balance"),
    output:
        "<results>/harmonic_balance/{name}.nc",
    log:
        "<logs>/harmonic_balance/{name}.log",
    cache: SHARED
    conda:
        ENVIRONMENT
    params:
        **parameters("harmonic_balance"),
    message:
        "Harmonic balance of the curve {wildcards.name}"
    script:
        "../scripts/harmonic_balance.py"


# One job computes all entries of the configuration, because computing an entry takes less time than
# starting a job.
rule design_orbit:
    input:
        code=code("design_orbit"),
        kernels=KERNELS,
    output:
        data("design_orbit"),
    log:
        "<logs>/design_orbit.log",
    conda:
        ENVIRONMENT
    params:
        **parameters_of_all("design_orbit"),
    message:
        "Exact quiet orbits at the design points of curves"
    script:
        "../scripts/design_orbit.py"


rule harmonic_convergence:
    input:
        code=code("harmonic_convergence"),
        kernels=KERNELS,
    output:
        "<results>/harmonic_convergence/{name}.nc",
    log:
        "<logs>/harmonic_convergence/{name}.log",
    cache: SHARED
    conda:
        ENVIRONMENT
    params:
        **parameters("harmonic_convergence"),
    message:
        "Harmonic balance with many harmonics against the exact orbit, for {wildcards.name}"
    script:
        "../scripts/harmonic_convergence.py"
