rule missed_contacts:
    input:
        data("missed_contacts"),


rule grazing_passages:
    input:
        code=code("grazing_passages.py"),
        kernels=ancient("<results>/rival_kernels.compiled"),
    output:
        "<results>/missed_contacts/{passage}.nc",
    log:
        "<logs>/missed_contacts/{passage}.log",
    benchmark:
        "<benchmarks>/missed_contacts/{passage}.tsv"
    cache: SHARED
    priority: 1
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        **parts(missed_contacts_job, "missed_contacts"),
    message:
        "Contacts near grazing that integrators miss, {wildcards.passage}"
    script:
        "../scripts/grazing_passages.py"
