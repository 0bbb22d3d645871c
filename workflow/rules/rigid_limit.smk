rule rigid_limit:
    input:
        data("rigid_limit"),


rule rigid_error:
    input:
        code=code("rigid_error.py"),
        kernels=ancient("<results>/kernels.compiled"),
    output:
        "<results>/rigid_limit/{limit}.nc",
    log:
        "<logs>/rigid_limit/{limit}.log",
    benchmark:
        "<benchmarks>/rigid_limit/{limit}.tsv"
    cache: SHARED
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        **parts(rigid_limit_job, "rigid_limit"),
    message:
        "Rigid impacts against compliant contact, {wildcards.limit}"
    script:
        "../scripts/rigid_error.py"
