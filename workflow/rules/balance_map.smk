def balance_map_job(wildcards):
    entry = config["balance_map"][wildcards.balance_map]
    fixed = {key: entry[key] for key in ("damping", "linear_frequency") if key in entry}
    # the function follows rule (19) where it is given no clearance
    fixed |= {key: value for key, value in damper_of(entry).items() if value != "rule"}
    return {
        "parameter": entry["parameter"],
        "values": grid(entry["values"], "map_values"),
        "frequency_ratios": grid(entry["frequency_ratios"], "map_frequencies"),
        "fixed": fixed,
        "settling": config["settling"],
    }


rule balance_map:
    input:
        data("balance_map"),


rule harmonic_balance_map:
    input:
        code=code("harmonic_balance_map.py"),
        kernels=ancient("<results>/kernels.compiled"),
    output:
        "<results>/balance_map/{balance_map}.nc",
    log:
        "<logs>/balance_map/{balance_map}.log",
    benchmark:
        "<benchmarks>/balance_map/{balance_map}.tsv"
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        job=balance_map_job,
    message:
        "Harmonic balance against the true motions, the map {wildcards.balance_map}"
    script:
        "../scripts/harmonic_balance_map.py"
