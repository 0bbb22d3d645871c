rule design:
    input:
        data("free_design"),
        data("design"),
        data("design_orbit"),


rule free_harmonic_balance:
    input:
        code=code("free_harmonic_balance.py"),
    output:
        "<results>/free_design/{oscillator}.nc",
    log:
        "<logs>/free_design/{oscillator}.log",
    benchmark:
        "<benchmarks>/free_design/{oscillator}.tsv"
    cache: SHARED
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        **parts(free_design_job, "free_design"),
    message:
        "Harmonic balance of the free oscillator {wildcards.oscillator}"
    script:
        "../scripts/free_harmonic_balance.py"


rule harmonic_balance:
    input:
        code=code("harmonic_balance.py"),
    output:
        "<results>/design/{curve}.nc",
    log:
        "<logs>/design/{curve}.log",
    benchmark:
        "<benchmarks>/design/{curve}.tsv"
    cache: SHARED
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        **parts(design_job, "design"),
    message:
        "Harmonic balance and suppression band of the curve {wildcards.curve}"
    script:
        "../scripts/harmonic_balance.py"


rule design_orbit:
    input:
        code=code("design_orbit.py"),
        kernels=ancient("<results>/kernels.compiled"),
    output:
        "<results>/design_orbit/{curve}.nc",
    log:
        "<logs>/design_orbit/{curve}.log",
    benchmark:
        "<benchmarks>/design_orbit/{curve}.tsv"
    cache: SHARED
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        **parts(design_orbit_job, "design_orbit"),
    message:
        "True quiet orbit at the design point of the curve {wildcards.curve}"
    script:
        "../scripts/design_orbit.py"
