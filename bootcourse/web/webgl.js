// Programs and bodies for the graphics card: what scene.js draws with.

// A program of two shaders, with the places of its uniforms by name. Throws an Error if it does not compile.
function program(gl, [vertex, fragment]) {
  const code = gl.createProgram();
  [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]].forEach(([kind, text]) => {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(code, shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader) ?? "no shader");
  });
  gl.linkProgram(code);
  if (!gl.getProgramParameter(code, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(code) ?? "no program");
  const places = {};
  for (let i = 0; i < gl.getProgramParameter(code, gl.ACTIVE_UNIFORMS); i++) {
    const name = gl.getActiveUniform(code, i).name.replace("[0]", "");
    places[name] = gl.getUniformLocation(code, name);
  }
  return { code, places };
}

// A solid body as a function that draws it. corners: x, y, z in mm and the part, Int16Array; faces: Uint16Array.
function mesh(gl, { code }, corners, faces) {
  const array = gl.createVertexArray(), at = gl.getAttribLocation(code, "corner");
  gl.bindVertexArray(array);
  for (const [target, content] of [[gl.ARRAY_BUFFER, corners], [gl.ELEMENT_ARRAY_BUFFER, faces]]) {
    gl.bindBuffer(target, gl.createBuffer());
    gl.bufferData(target, content, gl.STATIC_DRAW);
  }
  gl.enableVertexAttribArray(at);
  gl.vertexAttribPointer(at, 4, gl.SHORT, false, 0, 0);
  return () => {
    gl.bindVertexArray(array);
    gl.drawElements(gl.TRIANGLES, faces.length, gl.UNSIGNED_SHORT, 0);
  };
}

// Flat triangles that change with each picture, as a function that draws them: x, y, two of the rim, four of the colour.
function layer(gl, { code }) {
  const array = gl.createVertexArray(), buffer = gl.createBuffer();
  gl.bindVertexArray(array);
  gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
  [["place", 2, 0], ["edge", 2, 8], ["tint", 4, 16]].forEach(([name, size, from]) => {
    const at = gl.getAttribLocation(code, name);
    gl.enableVertexAttribArray(at);
    gl.vertexAttribPointer(at, size, gl.FLOAT, false, 32, from);
  });
  return corners => {
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(corners), gl.STREAM_DRAW);
    gl.drawArrays(gl.TRIANGLES, 0, corners.length / 8);
  };
}

// A fir: two cones on a trunk, 6 m tall.
function cone() {
  const corners = [], faces = [], sides = 7;
  for (const [radius, foot, top, part] of [[250, 0, 1600, 1], [1700, 1100, 4300, 0], [1250, 2900, 6000, 0]]) {
    const first = corners.length / 4;
    for (let k = 0; k < sides; k++) {
      const angle = (2 * Math.PI * k) / sides;
      corners.push(radius * Math.cos(angle), radius * Math.sin(angle), foot, part);
      faces.push(first + k, first + ((k + 1) % sides), first + sides);
    }
    corners.push(0, 0, top, part);
  }
  return [new Int16Array(corners), new Uint16Array(faces)];
}

// A cube of one metre that stands on the ground.
function block() {
  const corners = [0, 1, 2, 3, 4, 5, 6, 7].flatMap(k => [k & 1 ? 500 : -500, k & 2 ? 500 : -500, k & 4 ? 1000 : 0, 0]);
  return [new Int16Array(corners), new Uint16Array([4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 1, 3, 7, 1, 7, 5,
    0, 4, 6, 0, 6, 2])];
}
