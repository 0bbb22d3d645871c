rule contact_model:
    input:
        data("contact_model"),


rule contact_map:
    input:
        code=code("contact_map.py"),
        kernels=ancient("<results>/kernels.compiled"),
    output:
        "<results>/contact_model/{contact}.nc",
    log:
        "<logs>/contact_model/{contact}.log",
    benchmark:
        "<benchmarks>/contact_model/{contact}.tsv"
    cache: SHARED
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        **parts(contact_model_job, "contact_model"),
    message:
        "Contact model and contacts of motions, {wildcards.contact}"
    script:
        "../scripts/contact_map.py"
