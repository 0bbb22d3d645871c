scattergather:
    study=config["chunks"],


rule studies:
    input:
        data("studies"),


rule study_cells:
    input:
        code=code("study_cells.py"),
        kernels=ancient("<results>/kernels.compiled"),
    output:
        "<results>/study_chunks/{study}/{scatteritem}.nc",
    log:
        "<logs>/study_chunks/{study}/{scatteritem}.log",
    benchmark:
        "<benchmarks>/study_chunks/{study}/{scatteritem}.tsv"
    cache: SHARED
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        **parts(study_cells_job, "studies"),
    message:
        "Chunk {wildcards.scatteritem} of the study {wildcards.study}"
    script:
        "../scripts/study_cells.py"


rule study_grid:
    input:
        chunks=gather.study("<results>/study_chunks/{{study}}/{scatteritem}.nc"),
        code=code("study_grid.py"),
    output:
        "<results>/studies/{study}.nc",
    log:
        "<logs>/studies/{study}.log",
    benchmark:
        "<benchmarks>/studies/{study}.tsv"
    cache: SHARED
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    message:
        "Gathering the study {wildcards.study}"
    script:
        "../scripts/study_grid.py"
