function starter()
  % Triad, lesson {{lesson}}, question {{question}}.
  %
  % Reads states.json, evaluates your equations at each state, writes answer.json, which you hand in.
  % MATLAB from R2016b: starter     Octave from 7: octave-cli --eval starter     The file keeps the name starter.m.
  given = jsondecode(fileread('states.json'));
  count = numel(given.states);
  text = cell(1, count);
  for k = 1:count
    state = item(given.states, k);
    text{k} = jsonencode(equations(given, state.q(:), state.qd(:), state.t, k));
  end
  file = fopen('answer.json', 'w');
  fprintf(file, '{"states":[%s]}', strjoin(text, ','));
  fclose(file);
  fprintf('answer.json written: %d states, seed %s\n', count, given.seed);
end

function [r, u, v, w] = vectors(body, x)
  % The vectors r, u, v, w of a body in a column of coordinates x (q or qd).
  first = body.first_column;  % counts from 0, the indices here from 1
  r = x(first + (1:3)); u = x(first + (4:6)); v = x(first + (7:9)); w = [];
  if strcmp(body.coordinates, 'full')
    w = x(first + (10:12));
  end  % reduced: w = cross(u, v) is yours to compute
end

function answer = equations(given, q, qd, t, k)
  % What is asked for, at state k. given has bodies, joint_rows, rows, columns, gravity.
  n = numel(given.columns); m = numel(given.rows);
  % Your equations begin here.
{{returns}}
  % Your equations end here.
end

function b = item(list, k)
  % Element k of a list, whether it was read as an array or as cells.
  if iscell(list), b = list{k}; else, b = list(k); end
end
