# Triad, lesson {{lesson}}, question {{question}}.
#
# Reads states.json, evaluates your equations at each state, writes answer.json, which you hand in.
# Needs the package JSON:  julia -e 'using Pkg; Pkg.add("JSON")'   Run:  julia starter.jl
using JSON

"The vectors r, u, v, w of a body in a vector of coordinates x (q or qd)."
function vectors(body, x)
    first = body["first_column"]  # counts from 0, Julia's indices from 1
    part(k) = x[first+k+1:first+k+3]
    w = body["coordinates"] == "full" ? part(9) : nothing  # reduced: w = cross(u, v) is yours to compute
    return part(0), part(3), part(6), w
end

"What is asked for, at one state. given has bodies, joint_rows, rows, columns, gravity."
function equations(given, q, qd, t, k)
    n, m = length(given["columns"]), length(given["rows"])
    # Your equations begin here.
{{returns}}
    # Your equations end here.
    return answer
end

lines(matrix) = [matrix[i, :] for i in axes(matrix, 1)]
written(x) = x isa AbstractMatrix ? lines(x) : x

given = JSON.parsefile("states.json")
answers = map(enumerate(given["states"])) do (k, s)
    answer = equations(given, Float64.(s["q"]), Float64.(s["qd"]), s["t"], k)
    Dict(name => written(value) for (name, value) in answer)
end
open("answer.json", "w") do file
    JSON.print(file, Dict("states" => answers))
end
println("answer.json written: ", length(answers), " states, seed ", repr(given["seed"]))
