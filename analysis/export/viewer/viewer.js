"use strict";
// Draws the states of a run. Grains are squares that face the camera, shaded as spheres: with an orthographic camera that is exact.
(function () {
  const byId = (id) => document.getElementById(id);
  const data = JSON.parse(byId("data").textContent);

  // ---- data ----

  function bytes(text) {
    const raw = atob(text), array = new Uint8Array(raw.length);
    for (let k = 0; k < raw.length; ++k) array[k] = raw.charCodeAt(k);
    return array;
  }
  const floats = (text) => new Float32Array(bytes(text).buffer);
  const whole = (text) => new Uint32Array(bytes(text).buffer);
  const radius = floats(data.radius), count = radius.length;
  function state(number) {
    const packed = data.states[number];
    const contacts = { first: whole(packed.first), between: floats(packed.between), bonded: bytes(packed.bonded) };
    return { ...packed, ...contacts, position: floats(packed.position) };
  }

  // ---- legends ----

  const css = (colour) => `rgb(${colour.map((value) => Math.round(255 * value)).join(",")})`;
  const gradient = `linear-gradient(90deg,${data.scale.map(css).join(",")})`;
  function legend(entry) {
    return entry.colour ? `<span><span class="patch" style="background:${css(entry.colour)}"></span>${entry.text}</span>`
      : `<span>${entry.low}<span class="scale" style="background:${gradient}"></span>${entry.high}</span>`;
  }

  // ---- what is drawn ----

  const canvas = document.createElement("canvas"), context = canvas.getContext("webgl2");
  if (!context) {
    byId("message").textContent = "This page needs WebGL 2, which this browser does not offer.";
    return;
  }
  document.body.insertBefore(canvas, document.body.firstChild);
  const renderer = new THREE.WebGLRenderer({ canvas, context, antialias: true });
  renderer.setClearColor(0xffffff);
  const scene = new THREE.Scene(), camera = new THREE.OrthographicCamera(-1, 1, 1, -1, -1e6, 1e6);
  const controls = new THREE.OrbitControls(camera, canvas);

  const square = new Float32Array([-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0]);
  const grains = new THREE.InstancedBufferGeometry();
  grains.setAttribute("position", new THREE.BufferAttribute(square, 3));
  grains.setIndex([0, 1, 2, 0, 2, 3]);
  const instanced = (name, array, size) => {
    const attribute = new THREE.InstancedBufferAttribute(array, size);
    grains.setAttribute(name, attribute);
    return attribute;
  };
  const centre = instanced("centre", new Float32Array(3 * count), 3), colour = new THREE.InstancedBufferAttribute(new Uint8Array(3 * count), 3, true);
  grains.setAttribute("colour", colour);
  instanced("radius", radius, 1);
  const spheres = new THREE.ShaderMaterial({
    extensions: { fragDepth: true },
    uniforms: { size: { value: 1 }, near: { value: 1 }, depth: { value: 1 } },
    vertexShader: `
      attribute vec3 centre, colour; attribute float radius; uniform float size;
      varying vec3 seen, tint; varying vec2 corner; varying float reach;
      void main() {
        corner = position.xy; tint = colour; reach = size * radius;
        seen = (modelViewMatrix * vec4(centre, 1.0)).xyz;
        gl_Position = projectionMatrix * vec4(seen + vec3(reach * corner, 0.0), 1.0);
      }`,
    fragmentShader: `
      uniform mat4 projectionMatrix; uniform float near, depth;
      varying vec3 seen, tint; varying vec2 corner; varying float reach;
      void main() {
        float square = dot(corner, corner);
        if (square > 1.0) discard;
        vec3 normal = vec3(corner, sqrt(1.0 - square));
        float z = seen.z + reach * normal.z;
        float light = 0.45 + 0.55 * max(0.0, dot(normal, normalize(vec3(-0.4, 0.6, 0.8))));
        float haze = 0.55 * clamp((near - z) / depth, 0.0, 1.0);
        gl_FragColor = vec4(mix(tint * light, vec3(1.0), haze), 1.0);
        gl_FragDepthEXT = 0.5 + 0.5 * (projectionMatrix[2][2] * z + projectionMatrix[3][2]);
      }`,
  });
  const mesh = new THREE.Mesh(grains, spheres);
  mesh.frustumCulled = false;
  scene.add(mesh);
  const contacts = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ vertexColors: THREE.VertexColors }));
  contacts.frustumCulled = false;
  contacts.visible = false;
  scene.add(contacts);
  const CONTACT = [0.25, 0.25, 0.25];
  const glass = new THREE.MeshBasicMaterial({ color: 0x888888, transparent: true, opacity: 0.3, side: THREE.DoubleSide, depthWrite: false });
  const planes = new THREE.Group();
  scene.add(planes);
  let box = null;

  // ---- showing a state ----

  const slider = byId("slider");
  slider.max = data.states.length - 1;
  byId("title").textContent += data.title ? `: ${data.title.replace(/\$/g, "")}` : "";
  let shown = 0, reach = 1;

  function showColours(s) {
    const way = byId("colour").value;
    colour.array.set(bytes(s.colours[way]));
    colour.needsUpdate = true;
    byId("legend").innerHTML = data.legends[way].map(legend).join(" ");
  }
  function showContacts(s) {
    const ends = new Float32Array(2 * s.between.length), tints = new Float32Array(ends.length);
    for (let m = 0; m < s.first.length; ++m) {
      for (let k = 0; k < 3; ++k) {
        const begin = s.position[3 * s.first[m] + k];
        ends[6 * m + k] = begin;
        ends[6 * m + 3 + k] = begin + s.between[3 * m + k];
        tints[6 * m + k] = tints[6 * m + 3 + k] = (s.bonded[m] ? data.bond : CONTACT)[k];
      }
    }
    contacts.geometry.dispose();
    contacts.geometry = new THREE.BufferGeometry();
    contacts.geometry.setAttribute("position", new THREE.BufferAttribute(ends, 3));
    contacts.geometry.setAttribute("color", new THREE.BufferAttribute(tints, 3));
  }
  function showPlanes(s) {
    planes.remove(...planes.children);
    for (const [axis, place] of s.planes) {
      const plane = new THREE.Mesh(new THREE.PlaneBufferGeometry(2 * reach, 2 * reach), glass);
      plane.position.setComponent(axis, place);
      if (axis === 0) plane.rotation.y = Math.PI / 2;
      if (axis === 1) plane.rotation.x = Math.PI / 2;
      planes.add(plane);
    }
  }
  function showBox(s) {
    if (box) scene.remove(box);
    if (!s.cell) return;
    const [size, corner] = s.cell, edges = new THREE.EdgesGeometry(new THREE.BoxBufferGeometry(...size));
    box = new THREE.LineSegments(edges, new THREE.LineBasicMaterial({ color: 0x999999 }));
    box.position.set(...size.map((length, k) => corner[k] + length / 2));
    scene.add(box);
  }
  function show(number) {
    shown = number;
    slider.value = number;
    const s = state(number);
    centre.array.set(s.position);
    centre.needsUpdate = true;
    showColours(s);
    if (contacts.visible) showContacts(s);
    showBox(s);
    showPlanes(s);
    byId("time").textContent = `t = ${(1e9 * s.time).toFixed(1)} ns`;
    draw();
  }

  // ---- camera ----

  function resize() {
    const width = window.innerWidth, height = window.innerHeight, less = Math.min(width, height);
    renderer.setPixelRatio(window.devicePixelRatio);
    renderer.setSize(width, height);
    camera.right = (1.15 * reach * width) / less, camera.left = -camera.right;
    camera.top = (1.15 * reach * height) / less, camera.bottom = -camera.top;
    camera.updateProjectionMatrix();
    draw();
  }
  function showLength() { // a round length of about a sixth of the width
    const pixels = (window.innerWidth * camera.zoom) / (camera.right - camera.left) / data.unit; // per metre
    const about = window.innerWidth / 6 / pixels, power = Math.pow(10, Math.floor(Math.log10(about)));
    const length = power * [5, 2, 1].find((digit) => digit * power <= about);
    byId("length").style.width = `${length * pixels}px`;
    byId("length").textContent = length < 0.9999e-6 ? `${Math.round(1e9 * length)} nm` : `${Math.round(1e6 * length)} µm`;
  }
  let scheduled = false;
  function draw() {
    if (scheduled) return;
    scheduled = true;
    requestAnimationFrame(() => {
      scheduled = false;
      controls.update();
      const size = contacts.visible ? 0.35 : 1;
      Object.assign(spheres.uniforms.size, { value: size });
      const ahead = camera.position.distanceTo(controls.target);
      spheres.uniforms.near.value = reach - ahead;
      spheres.uniforms.depth.value = 2 * reach;
      renderer.render(scene, camera);
      showLength();
      document.body.dataset.drawn = shown; // for whoever waits for it
    });
  }
  function start() {
    const s = state(0);
    for (let k = 0; k < count; ++k)
      reach = Math.max(reach, Math.hypot(s.position[3 * k], s.position[3 * k + 1], s.position[3 * k + 2]) + radius[k]);
    camera.position.set(0.2 * reach, 0.3 * reach, 3 * reach);
    controls.target.set(0, 0, 0);
    controls.addEventListener("change", draw);
  }

  let playing = 0;
  byId("play").onclick = () => {
    if (playing) clearInterval(playing);
    playing = playing ? 0 : setInterval(() => show((shown + 1) % data.states.length), 100);
    byId("play").textContent = playing ? "stop" : "play";
  };
  slider.oninput = () => show(Number(slider.value));
  byId("colour").onchange = () => show(shown);
  byId("contacts").onchange = (event) => {
    contacts.visible = event.target.checked;
    show(shown);
  };
  window.onresize = resize;
  start();
  show(0);
  resize();
})();
