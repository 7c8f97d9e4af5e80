//! The order of elimination.

use std::collections::BTreeSet;

/// Greedy minimum degree: the order, and for each eliminated block its neighbours at that moment. It ends early where more than `most`
/// pairs of neighbours have come together: those are the products of blocks that a factorization takes.
///
/// Among equals the block that was touched longest ago goes first, so that a chain is eliminated from both ends and
/// neighbouring steps of the program do not wait for each other.
pub fn minimum_degree(mut graph: Vec<BTreeSet<usize>>, most: usize) -> (Vec<usize>, Vec<Vec<usize>>) {
    let mut products = 0;
    let mut touched = vec![0; graph.len()];
    let mut queue: BTreeSet<(usize, usize, usize)> =
        graph.iter().enumerate().map(|(i, n)| (n.len(), 0, i)).collect();
    let mut order = Vec::with_capacity(graph.len());
    let mut fill = Vec::with_capacity(graph.len());
    while let Some((_, _, block)) = queue.pop_first() {
        let neighbours: Vec<usize> = std::mem::take(&mut graph[block]).into_iter().collect();
        products += neighbours.len() * (neighbours.len() + 1) / 2;
        if products > most {
            break;
        }
        for &i in &neighbours {
            queue.remove(&(graph[i].len(), touched[i], i));
            graph[i].remove(&block);
        }
        for (at, &i) in neighbours.iter().enumerate() {
            for &j in &neighbours[at + 1..] {
                graph[i].insert(j);
                graph[j].insert(i);
            }
        }
        order.push(block);
        for &i in &neighbours {
            touched[i] = order.len();
            queue.insert((graph[i].len(), touched[i], i));
        }
        fill.push(neighbours);
    }
    (order, fill)
}
