rule release_scan:
    input:
        data("release_scan"),


rule release_destinations:
    input:
        code=code("release_destinations.py"),
        kernels=ancient("<results>/kernels.compiled"),
    output:
        "<results>/release_scan/{scan}.nc",
    log:
        "<logs>/release_scan/{scan}.log",
    benchmark:
        "<benchmarks>/release_scan/{scan}.tsv"
    cache: SHARED
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        **parts(release_scan_job, "release_scan"),
    message:
        "Where releases lead over frequency, the scan {wildcards.scan}"
    script:
        "../scripts/release_destinations.py"
