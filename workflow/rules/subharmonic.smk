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
    cache: SHARED
    priority: 1
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        **parts(response_job, "subharmonic"),
    message:
        "What the damper makes of the one-third subharmonic, for the curve {wildcards.curve}"
    script:
        "../scripts/subharmonic_suppression.py"
