// What is hard to read in the page as it is shown now: an array of sentences, empty where all is well.
(() => {
  const LEAST_TEXT = 9, TEXT_CONTRAST = 4.5, LINE_CONTRAST = 3; // px; WCAG 2.2, 1.4.3 and 1.4.11
  const found = [];

  const colour = text => {
    const n = (text.match(/[\d.]+/g) || []).map(Number);
    return text.startsWith("rgb") ? {rgb: n.slice(0, 3), alpha: n.length > 3 ? n[3] : 1} : null;
  };
  const luminance = rgb => {
    const [r, g, b] = rgb.map(v => v / 255).map(v => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const contrast = (a, b) => {
    const [low, high] = [luminance(a), luminance(b)].sort((x, y) => x - y);
    return (high + 0.05) / (low + 0.05);
  };
  // Of an element, without what lies on it: its own background or its ancestors'; in a picture that of
  // the last opaque shape drawn before it that covers its middle.
  const background = element => {
    const svg = element.ownerSVGElement;
    if (svg) {
      const box = element.getBoundingClientRect(), x = (box.left + box.right) / 2, y = (box.top + box.bottom) / 2;
      let under = null;
      for (const shape of svg.querySelectorAll("rect")) {
        const b = shape.getBoundingClientRect(), style = getComputedStyle(shape), fill = colour(style.fill);
        const before = shape.compareDocumentPosition(element) & Node.DOCUMENT_POSITION_FOLLOWING;
        if (before && fill && fill.alpha === 1 && style.fillOpacity === "1" && b.left <= x && x <= b.right &&
            b.top <= y && y <= b.bottom)
          under = fill.rgb;
      }
      if (under) return under;
    }
    for (let e = svg || element; e; e = e.parentElement) {
      const c = colour(getComputedStyle(e).backgroundColor);
      if (c && c.alpha === 1) return c.rgb;
    }
    return [255, 255, 255];
  };

  const texts = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const element = node.parentElement, text = node.data.trim();
    if (!text || element.closest("style, title")) continue;
    const range = document.createRange();
    range.selectNodeContents(node);
    const boxes = [...range.getClientRects()].filter(b => b.width > 0 && b.height > 0);
    if (boxes.length && getComputedStyle(element).visibility === "visible") texts.push({element, text, boxes});
  }
  if (texts.length < 20) found.push(`only ${texts.length} texts are shown`);

  const wide = document.documentElement.scrollWidth, room = document.documentElement.clientWidth;
  if (wide > room) found.push(`the page is ${wide} px wide and scrolls in ${room}`);

  for (const {element, text, boxes} of texts) {
    const svg = element.ownerSVGElement, style = getComputedStyle(element);
    const scale = svg ? element.getScreenCTM().d : 1, size = parseFloat(style.fontSize) * scale;
    if (size < LEAST_TEXT) found.push(`'${text}' has letters of ${size.toFixed(1)} px`);
    const ink = colour(svg ? style.fill : style.color), paper = background(element);
    const ratio = contrast(ink.rgb, paper);
    if (ratio < TEXT_CONTRAST || ink.alpha < 1)
      found.push(`'${text}' has a contrast of ${ratio.toFixed(2)} (${ink.rgb} on ${paper})`);
    // Cut off: outside its picture, or outside the page where no box around it scrolls.
    let scroller = element;
    while (scroller && !/auto|scroll/.test(getComputedStyle(scroller).overflowX)) scroller = scroller.parentElement;
    const frame = svg ? svg.getBoundingClientRect() : scroller && scroller !== document.documentElement ? null
      : {left: 0, right: room, top: -1e9, bottom: 1e9};
    for (const b of boxes)
      if (frame && (b.left < frame.left - 1 || b.right > frame.right + 1 || b.top < frame.top - 1 || b.bottom > frame.bottom + 1))
        found.push(`'${text}' is cut off`);
  }

  // Texts of a picture, or of the page, that lie on each other; the boxes hold the line's full height.
  const boxes = texts.flatMap(t => t.boxes.map(b => ({owner: t.element.ownerSVGElement, element: t.element, text: t.text, left: b.left + 1,
    right: b.right - 1, top: b.top + 0.15 * b.height, bottom: b.bottom - 0.15 * b.height})));
  boxes.sort((a, b) => a.top - b.top);
  boxes.forEach((a, i) => {
    for (let j = i + 1; j < boxes.length && boxes[j].top < a.bottom; ++j) {
      const b = boxes[j];
      if (a.owner === b.owner && a.element !== b.element && a.left < b.right && b.left < a.right)
        found.push(`'${a.text}' and '${b.text}' overlap`);
    }
  });

  // Curves and points of a picture: told apart by dashes, width and marker alone, and seen on their paper.
  const outline = shape => {
    const p = (shape.getAttribute("points") || "").split(" ").filter(Boolean).map(q => q.split(",").map(Number));
    const hollow = contrast(colour(getComputedStyle(shape).fill).rgb, background(shape)) < 1.2;
    return shape.tagName + p.map(q => [Math.round(q[0] - p[0][0]), Math.round(q[1] - p[0][1])]).join(";") + (hollow ? "hollow" : "");
  };
  for (const svg of document.querySelectorAll("svg.plot")) {
    if (!svg.getClientRects().length) continue;
    const looks = new Map();
    for (const group of svg.querySelectorAll("g")) {
      const name = group.querySelector(":scope > title"), line = group.querySelector("path.curve");
      if (!name) continue;
      const style = line && getComputedStyle(line);
      const marks = [...group.querySelectorAll("circle:not(.halo), polygon")];
      const crossed = marks.length && marks[0].previousElementSibling && marks[0].previousElementSibling.tagName === "path" &&
        marks[0].previousElementSibling !== line && !marks[0].previousElementSibling.classList.contains("limit");
      const look = (style ? `${style.strokeDasharray} ` : "") + (marks.length ? outline(marks[0]) + (crossed ? "crossed" : "") : "");
      if (looks.has(look)) found.push(`${name.textContent} and ${looks.get(look)} look the same without colour`);
      looks.set(look, name.textContent);
      if (line && style.fill !== "none") found.push(`the curve of ${name.textContent} is filled`);
      const ink = colour(style ? style.stroke : getComputedStyle(marks[0]).stroke);
      const ratio = contrast(ink.rgb, background(line || marks[0]));
      if (ratio < LINE_CONTRAST) found.push(`${name.textContent} has a contrast of ${ratio.toFixed(2)}`);
    }
    for (const front of svg.querySelectorAll("path.front"))
      if (getComputedStyle(front).fill !== "none") found.push("the front is filled");
  }
  return found;
})()
