% Bode diagrams and margins of the linear model in @FILE@, written by tandemlift. It needs the Control System Toolbox.
% The model is discrete, of deviations from a point of a flight: x(k+1) = A x(k) + B u(k), y(k) = C x(k) + D u(k).
data = load(fullfile(fileparts(mfilename("fullpath")), "@FILE@"));
model = ss(data.A, data.B, data.C, data.D, data.step);
model.InputName = data.inputs(:, 1);
model.InputUnit = data.inputs(:, 2);
model.OutputName = data.outputs(:, 1);
model.OutputUnit = data.outputs(:, 2);

% The response of the position to a push, or else of the first outputs to the first inputs.
inputs = find(startsWith(model.InputName, "push_force"));
outputs = find(startsWith(model.OutputName, "position"));
if isempty(inputs) || isempty(outputs)
    inputs = 1:min(3, size(model, 2));
    outputs = 1:min(3, size(model, 1));
end
figure("Name", "@NAME@")
bode(model(outputs, inputs))
grid on

% Margins of a loop that is cut at a rotor, from a model of the options
%   --inputs thrust_offsets --outputs rotor_thrusts
% An offset d is added to a thrust u = S d of a closed loop, S = 1 / (1 + L), so that L = 1 / S - 1.
for i = 1:min(size(model))
    if startsWith(model.InputName{i}, "thrust_offsets") && startsWith(model.OutputName{i}, "rotor_thrusts")
        S = model(i, i);
        L = minreal(1 / S - 1);
        [gain, phase, ~, crossover] = margin(L);
        fprintf("%s: gain margin %.1f dB, phase margin %.1f deg at %.2f rad/s\n", model.InputName{i}, ...
            20 * log10(gain), phase, crossover)
    end
end
