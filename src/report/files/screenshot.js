// The picture with its caption and legend, as a PNG file.

function saveScreenshot(canvas, data, shown) {
  const style = getComputedStyle(document.body), ratio = canvas.width / canvas.clientWidth, band = 74 * ratio;
  const sheet = document.createElement("canvas"), pen = sheet.getContext("2d");
  sheet.width = canvas.width;
  sheet.height = canvas.height + band;
  pen.fillStyle = style.backgroundColor;
  pen.fillRect(0, 0, sheet.width, sheet.height);
  pen.drawImage(canvas, 0, 0);
  pen.fillStyle = style.color;
  pen.font = 14 * ratio + "px system-ui, sans-serif";
  pen.fillText(document.title + ": " + data.states[shown.state].label, 14 * ratio, canvas.height + 18 * ratio);
  const shades = shown.field && colouring(shown.field);
  if (shades) pen.fillText(shown.field.title + (shown.field.unit ? " [" + shown.field.unit + "]" : ""), 14 * ratio, canvas.height + 42 * ratio);
  if (shades && shades.map) {
    const left = 14 * ratio, width = 240 * ratio, top = canvas.height + 50 * ratio;
    shades.map.forEach((shade, k) => {
      pen.fillStyle = css(shade);
      pen.fillRect(left + width * k / shades.map.length, top, width / shades.map.length + 1, 10 * ratio);
    });
    pen.fillStyle = style.color;
    pen.fillText(figure(shades.range[0], 3) + " to " + withUnit(shades.range[1], shown.field.unit, 3), left + width + 12 * ratio, top + 10 * ratio);
  }
  const link = document.createElement("a");
  link.download = data.name + ".png";
  link.href = sheet.toDataURL("image/png");
  link.click();
}
