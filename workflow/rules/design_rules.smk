rule design_rules:
    input:
        data("design_rules"),


rule optima_against_rules:
    input:
        code=code("optima_against_rules.py"),
        kernels=ancient("<results>/kernels.compiled"),
    output:
        "<results>/design_rules/{grid}.nc",
    log:
        "<logs>/design_rules/{grid}.log",
    benchmark:
        "<benchmarks>/design_rules/{grid}.tsv"
    cache: SHARED
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        **parts(design_rules_job, "design_rules"),
    message:
        "Rules for the clearance against the optimum of the motion, on the grid {wildcards.grid}"
    script:
        "../scripts/optima_against_rules.py"
