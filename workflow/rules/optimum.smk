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
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        job=optimum_job,
    message:
        "Largest displacement against clearance, and its optimum, for {wildcards.optimum}"
    script:
        "../scripts/clearance_sweep.py"
