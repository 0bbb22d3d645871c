def contact_model_job(wildcards):
    model = config["contact_model"][wildcards.contact]
    return {
        "oscillator": oscillator_of(model["oscillator"]),
        "damper": damper_of(model),
        "frequencies": model["frequencies"],
        "used": model["restitutions"],
        "periods": model["periods"],
        "starts": config["search"]["scan_starts"],
        "seed": config["seed"],
        "map": {
            "restitutions": [model["smallest_restitution"], 1, model["cells"]["restitutions"]],
            "loads": [model["largest_load"], model["cells"]["loads"]],
        },
        "settling": config["settling"],
    }


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
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        job=contact_model_job,
    message:
        "Contact model and contacts of motions, {wildcards.contact}"
    script:
        "../scripts/contact_map.py"
