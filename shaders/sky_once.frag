// sky_once.frag — the environment where samples see nothing else.

out vec4 out_color;

void main() {
  out_color = seen_share() * vec4(env_seen(normalize(seen_along())), 1.0);
}
