"""The straight-line code of a MATLAB function file as Python, read by its own rules (MATLAB's reference: elements from 1 in round
brackets, ^, a column as [a; b]) and the helpers written anew:  matlab_to_python.py FILE  prints the module, with the functions
initial(), derivative(x, u, t) and output(x, u, t)."""
import re
import sys

HELPERS = """
import math
nan = math.nan
def chosen(condition, a, b): return a if condition != 0 else b
def real_power(a, b): return nan if a < 0 and b != math.trunc(b) else a ** b
def real_sqrt(a): return nan if a < 0 else math.sqrt(a)
def real_log(a): return nan if a < 0 else math.log(a)
def real_asin(a): return nan if abs(a) > 1 else math.asin(a)
def real_acos(a): return nan if abs(a) > 1 else math.acos(a)
def sign(a): return (a > 0) - (a < 0)
double, Inf = float, math.inf
from math import sin, cos, tan, atan, atan2, tanh, exp
"""
functions = {"initial_state": "def initial():", "derivative": "def derivative(x, u, t):", "output": "def output(x, u, t):"}
print(HELPERS)
text = open(sys.argv[1]).read()
for name, head in functions.items():
    body = re.search(rf"\nfunction \w+ = {name}\(.*?\)\n(.*?)\nend\n", text, re.S).group(1)
    print(head)
    for line in body.splitlines():
        assert re.fullmatch(r"\w+ = .*;", line), line
        target, expression = line[:-1].split(" = ", 1)
        expression = re.sub(r"\b([xu])\((\d+)\)", lambda m: f"{m[1]}[{int(m[2]) - 1}]", expression)
        expression = "[]" if expression == "zeros(0, 1)" else expression.replace(";", ",")
        print(f"    {target} = {expression}")
    print(f"    return {target}\n")
