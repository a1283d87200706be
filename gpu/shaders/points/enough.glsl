// Some rays only ask whether they hit anything. After consider.glsl.
bool any_will_do;

bool enough() { return any_will_do && best_rank != none; }
