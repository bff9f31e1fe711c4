// shadow.frag — depth is all that counts.

void main() {
}
