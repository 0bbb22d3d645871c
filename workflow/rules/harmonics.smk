rule harmonics:
    input:
        data("harmonics"),


rule harmonic_convergence:
    input:
        code=code("harmonic_convergence.py"),
        kernels=ancient("<results>/kernels.compiled"),
    output:
        "<results>/harmonics/{harmonics}.nc",
    log:
        "<logs>/harmonics/{harmonics}.log",
    benchmark:
        "<benchmarks>/harmonics/{harmonics}.tsv"
    cache: SHARED
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        **parts(harmonics_job, "harmonics"),
    message:
        "Harmonic balance with many harmonics against the exact orbit, for {wildcards.harmonics}"
    script:
        "../scripts/harmonic_convergence.py"
