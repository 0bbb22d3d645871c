rule response:
    input:
        data("response"),
        data("motion"),
        data("collisions"),


rule frequency_response:
    input:
        code=code("frequency_response.py"),
        kernels=ancient("<results>/kernels.compiled"),
    output:
        "<results>/response/{curve}.nc",
    log:
        "<logs>/response/{curve}.log",
    benchmark:
        "<benchmarks>/response/{curve}.tsv"
    cache: SHARED
    priority: 1
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        **parts(response_job, "response"),
    message:
        "Motions with the damper over frequency, of the curve {wildcards.curve}"
    script:
        "../scripts/frequency_response.py"


rule steady_motion:
    input:
        code=code("steady_motion.py"),
        kernels=ancient("<results>/kernels.compiled"),
    output:
        "<results>/motion/{motion}.nc",
    log:
        "<logs>/motion/{motion}.log",
    benchmark:
        "<benchmarks>/motion/{motion}.tsv"
    cache: SHARED
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        **parts(motion_job, "motion"),
    message:
        "Steady motion {wildcards.motion}"
    script:
        "../scripts/steady_motion.py"


rule collisions:
    input:
        code=code("collisions.py"),
        kernels=ancient("<results>/kernels.compiled"),
    output:
        "<results>/collisions/{motion}.nc",
    log:
        "<logs>/collisions/{motion}.log",
    benchmark:
        "<benchmarks>/collisions/{motion}.tsv"
    cache: SHARED
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        **parts(collisions_job, "collisions"),
    message:
        "Starts that lead to collisions, {wildcards.motion}"
    script:
        "../scripts/collisions.py"
