rule optimum:
    input:
        data("optimum"),


rule clearance_sweep:
    input:
        code=code("clearance_sweep.py"),
        kernels=ancient("<results>/kernels.compiled"),
    output:
        "<results>/optimum/{optimum}.nc",
    log:
        "<logs>/optimum/{optimum}.log",
    benchmark:
        "<benchmarks>/optimum/{optimum}.tsv"
    cache: SHARED
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        **parts(optimum_job, "optimum"),
    message:
        "Largest displacement against clearance, and its optimum, for {wildcards.optimum}"
    script:
        "../scripts/clearance_sweep.py"
