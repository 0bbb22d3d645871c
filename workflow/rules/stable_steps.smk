rule stable_steps:
    input:
        data("stable_steps"),


rule fixed_step_runs:
    input:
        code=code("fixed_step_runs.py"),
        kernels=ancient("<results>/rival_kernels.compiled"),
    output:
        "<results>/stable_steps/{stepping}.nc",
    log:
        "<logs>/stable_steps/{stepping}.log",
    benchmark:
        "<benchmarks>/stable_steps/{stepping}.tsv"
    cache: SHARED
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        **parts(stable_steps_job, "stable_steps"),
    message:
        "Largest stable steps of fixed-step methods, {wildcards.stepping}"
    script:
        "../scripts/fixed_step_runs.py"
