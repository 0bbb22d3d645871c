rule subharmonic:
    input:
        data("subharmonic"),


rule subharmonic_suppression:
    input:
        code=code("subharmonic_suppression.py"),
        kernels=ancient("<results>/kernels.compiled"),
    output:
        "<results>/subharmonic/{curve}.nc",
    log:
        "<logs>/subharmonic/{curve}.log",
    benchmark:
        "<benchmarks>/subharmonic/{curve}.tsv"
    priority: 1
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        job=response_job,
    message:
        "What the damper makes of the one-third subharmonic, for the curve {wildcards.curve}"
    script:
        "../scripts/subharmonic_suppression.py"
