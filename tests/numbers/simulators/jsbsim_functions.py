"""Evaluates the functions and axes of an aerodynamics file of JSBSim, as its reference manual says what each element is, with Python's
standard library alone:  jsbsim_functions.py FILE < PROPERTIES  where PROPERTIES is JSON: a list of {property: value}, a row each.
Prints force or moment of each axis, a row each, as JSON."""
import json
import math
import sys
import xml.etree.ElementTree as xml

root = xml.parse(sys.argv[1]).getroot()
assert root.tag == "aerodynamics"


def value(node, properties):
    if node.tag == "value":
        return float(node.text)
    if node.tag == "property":
        return properties[node.text.strip()]
    inside = [value(one, properties) for one in node]
    if node.tag == "sum":
        return math.fsum(inside)
    if node.tag == "product":
        return math.prod(inside)
    a, b, *rest = inside + [0.0] * (2 - len(inside))
    return {
        "difference": lambda: a - b - sum(rest), "quotient": lambda: a / b, "pow": lambda: math.pow(a, b),
        "lt": lambda: float(a < b), "le": lambda: float(a <= b), "gt": lambda: float(a > b), "ge": lambda: float(a >= b),
        "ifthen": lambda: b if a else rest[0], "min": lambda: min(inside), "max": lambda: max(inside),
        "atan2": lambda: math.atan2(a, b), "ln": lambda: math.log(a), "abs": lambda: abs(a),
        **{name: lambda name=name: getattr(math, name)(a) for name in ["sin", "cos", "tan", "asin", "acos", "atan", "sqrt", "exp"]},
    }[node.tag]()


answers = []
for properties in json.load(sys.stdin):
    for node in root:
        if node.tag == "property":
            properties[node.text.strip()] = float(node.get("value"))
        if node.tag == "function":
            properties[node.get("name")] = value(node[0], properties)
    axes = [node for node in root if node.tag == "axis"]
    answers.append({axis.get("name") + " " + axis.get("frame"): value(axis.find("function")[0], properties) for axis in axes})
print(json.dumps(answers))
