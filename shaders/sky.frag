// sky.frag

in vec3 at_direction;

out vec4 out_color;

void main() {
  out_color = vec4(env_seen(normalize(at_direction)), 1.0);
}
