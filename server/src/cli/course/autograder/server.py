"""Shows one of the variants that were exported; grading is external, with the same numbers."""

import json
import os


def generate(data):
    path = os.path.join(data["options"]["question_path"], "variants.json")
    with open(path, encoding="utf-8") as file:
        variants = json.load(file)
    # The seed may be text or a number, as versions of PrairieLearn have it.
    variant = variants[int(str(data["variant_seed"]), 36) % len(variants)]
    data["params"]["triad_seed"] = variant["seed"]
    data["params"]["questions"] = variant["questions"]
    data["params"]["blank"] = variant["blank"]


def file(data):
    if data["filename"] == "answers.json":
        return data["params"]["blank"]
