% Bode diagrams and margins of the linear model in @FILE@, written by tandemlift, for MATLAB with the Control System
% Toolbox, or GNU Octave with its package "control".
% The model is discrete, of deviations from a point of a flight: x(k+1) = A x(k) + B u(k), y(k) = C x(k) + D u(k).
if exist("OCTAVE_VERSION", "builtin")
    pkg load control
end
data = load(fullfile(fileparts(mfilename("fullpath")), "@FILE@"));

% States that no input moves or no output shows change nothing; a flight has hundreds of them.
coupled = double(data.A ~= 0);
moved = any(data.B ~= 0, 2);
shown = any(data.C ~= 0, 1)';
before = -1;
while before < sum(moved) + sum(shown)
    before = sum(moved) + sum(shown);
    moved = moved | coupled * moved > 0;
    shown = shown | coupled' * shown > 0;
end
kept = moved & shown;
data.A = data.A(kept, kept);
data.B = data.B(kept, :);
data.C = data.C(:, kept);
model = ss(data.A, data.B, data.C, data.D, data.step);
input_names = data.inputs(:, 1);  % units are in the second columns
output_names = data.outputs(:, 1);
model.InputName = input_names;
model.OutputName = output_names;

% The response of the position to a push, or else of the first outputs to the first inputs.
inputs = find(strncmp(input_names, "push_force", 10));
outputs = find(strncmp(output_names, "position", 8));
if isempty(inputs) || isempty(outputs)
    inputs = 1:min(3, numel(input_names));
    outputs = 1:min(3, numel(output_names));
end
frequency = logspace(-1, log10(0.99 * pi / data.step), 600);
figure("Name", "@NAME@")
for i = 1:numel(outputs)
    for j = 1:numel(inputs)
        [gain, phase] = bode(model(outputs(i), inputs(j)), frequency);
        rows = 2 * numel(outputs);
        subplot(rows, numel(inputs), (2 * i - 2) * numel(inputs) + j)
        semilogx(frequency(:), 20 * log10(gain(:)))
        grid on
        title(strrep([input_names{inputs(j)} " to " output_names{outputs(i)}], "_", " "))
        ylabel("dB")
        subplot(rows, numel(inputs), (2 * i - 1) * numel(inputs) + j)
        semilogx(frequency(:), phase(:))
        grid on
        ylabel("deg")
    end
end
xlabel("rad/s")

% Margins of a loop that is cut at a rotor, from a model of the options
%   --inputs thrust_offsets --outputs rotor_thrusts
% An offset d is added to a thrust u = S d of a closed loop, S = 1 / (1 + L), so that L = 1 / S - 1. The margins nearest
% to 1 are read from the response at 600 frequencies: a model of a flight has hundreds of states.
loops = [];
for i = 1:min(numel(input_names), numel(output_names))
    if strncmp(input_names{i}, "thrust_offsets", 14) && strncmp(output_names{i}, "rotor_thrusts", 13)
        loops(end + 1) = i;
    end
end
if ~isempty(loops)
    L = zeros(numel(loops), numel(frequency));
    for k = 1:numel(frequency)
        z = exp(1i * frequency(k) * data.step);
        S = data.C(loops, :) * ((z * eye(size(data.A)) - data.A) \ data.B(:, loops)) + data.D(loops, loops);
        L(:, k) = 1 ./ diag(S) - 1;
    end
    for i = 1:numel(loops)
        gain = 20 * log10(abs(L(i, :)));
        phase = unwrap(angle(L(i, :))) * 180 / pi;
        at = find(gain(1:end-1) .* gain(2:end) < 0);  % where the gain crosses 0 dB
        part = gain(at) ./ (gain(at) - gain(at + 1));
        margins = mod(phase(at) + part .* (phase(at + 1) - phase(at)), 360) - 180;
        crossovers = frequency(at) .* (frequency(at + 1) ./ frequency(at)) .^ part;
        [~, nearest] = min(abs(margins));
        turns = floor((phase - 180) / 360);
        at = find(diff(turns));  % where the phase crosses 180 deg
        edge = 360 * max(turns(at), turns(at + 1)) + 180;
        part = (edge - phase(at)) ./ (phase(at + 1) - phase(at));
        gains = -(gain(at) + part .* (gain(at + 1) - gain(at)));
        [~, least] = min(abs(gains));
        fprintf("%s: gain margin %.1f dB, phase margin %.1f deg at %.2f rad/s\n", input_names{loops(i)}, ...
            gains(least), margins(nearest), crossovers(nearest))
    end
end
