% octave.txt: five samples, and beside them a value of every other kind that Octave saves: octave-cli make_octave.m
time = 0:0.1:0.4;
air.alpha = single ([1.5; 1.25; 1; NaN; 0.5]);
air.notes = {"two", {1, [2 3; 4 5]}, @(x) x * air.alpha};
air.q = [2; 4; 6; 8; 10];
air.of = struct ("a", {1, [2 3]});
global flap
flap = [7 8 9 10 11];
on = [true false; true true; false true; true false; false true];
once = true;
cube = reshape (1:8, 2, 2, 2);
deep = reshape (1:10, 5, 1, 2);
half = sparse ([1 4 5], [2 1 3], [0.5 -4 5], 5, 3);
large = sparse (1e6, 1e6);
scaled = 3 * eye (5, 2);
swapped = eye (5)([2 1 3 4 5], :);
waves = single ([1+2i 3; 4 5; 6 7; 8 9; 0 -1i]);
wave = 1+2i;
found = find ([1 0 1 1 1 1]);
down = 5:-1:1;
count = int16 ([1 2; 3 4; 5 6; 7 8; 9 10]);
text = "# name: q\n# type: scalar\n9\n";
rows = ["ab"; "cd"];
line = inline ("x^2");
again = 1;
save -text octave.txt time air flap on once cube deep half large scaled swapped waves wave found down count text rows line again
again = [5; 4; 3; 2; 1];
save -text -append octave.txt again
