#!/usr/bin/env bash
# Makes the gallery's stills of bodies anew: each is one frame of a scene that ships.
set -euo pipefail
cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../.."

still() { # scene, second, size, picture
  ./smokebox render "scenes/$1.yaml" --at "$2" --size "$3" -o "renders/gallery/$4.png" -y --quiet
}

still paper/fig13-complex-body 3.3 960x540 fig13-complex-body
still cloth 3.5 960x540 cloth
still rain 3 960x540 rain
still machine 6.9 960x540 machine
still stack 2.5 960x540 stack
still dominoes 2.3 960x540 dominoes
still chain 6.5 960x540 chain
still cradle 0.7 960x540 cradle
still paper/fig24-26-collision 0.5 640x360 fig24-before
still paper/fig24-26-collision 1.3 640x360 fig25-collision
still paper/fig24-26-collision 2.2 640x360 fig26-after
