// What the server says, in German: of scenes, runs and analyses. The English sentence is the key, with places for its values; it is
// as the engine's sources have it, which a test compares. `{reason}` and `{cause}` are sentences of this catalogue themselves.

export const told: Record<string, string> = {
  // Titles of problems: their codes, read as words.
  "No class": "Kein Kurs",
  "Scene syntax": "Der Text ist noch keine Szene",
  "Scene too large": "Die Szene ist zu groß",
  "Scene too long": "Der Text ist zu lang",
  "No such number": "Dort steht keine Zahl",
  "Unknown parameter": "Unbekannter Parameter",
  "Outside parameter": "Außerhalb des Bereichs",
  "No bodies": "Keine Körper",
  "Duplicate name": "Doppelter Name",
  "Reserved name": "Unzulässiger Name",
  "Unknown body": "Unbekannter Körper",
  "Unknown name": "Unbekannter Name",
  "Joint to itself": "Gelenk eines Körpers mit sich selbst",
  "Not finite": "Keine endliche Zahl",
  "Out of range": "Außerhalb des Bereichs",
  "Mass not positive": "Die Masse ist nicht positiv",
  "Inertia not physical": "Unmögliche Trägheitsmomente",
  "Inertia not symmetric": "Der Trägheitstensor ist nicht symmetrisch",
  "Orientation invalid": "Die Orientierung ist unklar",
  "Parameter invalid": "Der Parameter stimmt nicht",
  "Joint geometry": "Die Geometrie des Gelenks stimmt nicht",
  "Driver invalid": "Der Antrieb stimmt nicht",
  "Load invalid": "Die Last stimmt nicht",
  "Assembly failed": "Der Mechanismus lässt sich nicht schließen",
  "Start too far": "Der Anfang ist zu weit offen",
  "Motion impossible": "Die Bewegung ist unmöglich",
  "Masses too different": "Die Massen sind zu verschieden",
  "Constraints lost": "Die Gelenke halten nicht mehr",
  Diverged: "Der Lauf divergiert",
  "Step too small": "Die Schritte werden zu klein",
  "No convergence": "Keine Konvergenz",
  Stalled: "Der Lauf bleibt stecken",
  "Undetermined motion": "Unbestimmte Bewegung",
  "Integrator alone": "Diesen Integrator gibt es nicht allein",
  "Integrator unable": "Dieser Integrator kann das nicht",
  "Step limit": "Alle Schritte sind verbraucht",
  "Time outside run": "Zeit außerhalb des Laufs",
  "Analysis too large": "Zu groß für diese Analyse",
  "No equilibrium": "Kein Gleichgewicht",
  "No steady motion": "Keine stationäre Bewegung",
  "Not driven": "Nicht ganz angetrieben",
  "Free to spin": "Ein Körper dreht sich frei um sich selbst",
  "Singular start": "Singulärer Anfang",
  Unreachable: "Unerreichbar",
  "Branch lost": "Der Zweig ging verloren",
  "Too many positions": "Zu viele Lagen",
  "Cannot pin": "Der Körper lässt sich nicht festhalten",
  "Invalid room name": "Kein Name für einen Raum",
  "Room name taken": "Der Name ist vergeben",
  "Too many room names": "Zu viele Namen von Räumen",
  "Unknown room": "Diesen Raum gibt es nicht",
  "Room full": "Der Raum ist voll",
  "Too many rooms": "Alle Räume sind in Gebrauch",

  // A scene's text.
  "{path} (line {line}, column {column}): {reason}": "{path} (Zeile {line}, Spalte {column}): {reason}",
  "{path} (line {line}): {reason}": "{path} (Zeile {line}): {reason}",
  "unknown field `{field}`, expected one of {known}": "unbekannter Schlüssel `{field}`, möglich sind {known}",
  "unknown field `{field}`, expected {known}": "unbekannter Schlüssel `{field}`, möglich ist {known}",
  "unknown variant `{field}`, expected one of {known}": "unbekanntes Wort `{field}`, möglich sind {known}",
  "invalid type: {given}, expected a number": "falsche Art von Wert: {given} statt einer Zahl",
  "invalid type: {given}, expected a whole number": "falsche Art von Wert: {given} statt einer ganzen Zahl",
  "invalid type: {given}, expected a string":
    "falsche Art von Wert: {given} statt eines Textes in Anführungszeichen",
  "invalid type: {given}, expected a list in brackets":
    "falsche Art von Wert: {given} statt einer Liste in Klammern [ ]",
  "invalid type: {given}, expected an object in braces":
    "falsche Art von Wert: {given} statt eines Objekts in Klammern { }",
  "invalid type: {given}, expected an array of length {wanted}":
    "falsche Art von Wert: {given} statt einer Liste der Länge {wanted}",
  "invalid type: {given}, expected {wanted}": "falsche Art von Wert: {given} statt {wanted}",
  "invalid length {n}, expected an array of length {wanted}":
    "Länge {n} statt einer Liste der Länge {wanted}",
  "invalid value: {given}, expected {wanted}": "falscher Wert: {given} statt {wanted}",
  "duplicate field `{field}`": "der Schlüssel `{field}` steht zweimal da",
  "`{key}` is missing: write it between the braces that end here":
    "`{key}` fehlt: Schreib es zwischen die Klammern, die hier enden",
  "another kind of value belongs here": "hierher gehört ein Wert anderer Art",
  "more values than belong here": "mehr Werte, als hierher gehören",
  "a scene stands in braces, and this text begins otherwise":
    "eine Szene steht in geschweiften Klammern, und dieser Text beginnt anders",
  "trailing comma": "ein Komma zu viel am Ende",
  "EOF while parsing a value": "der Text endet, wo ein Wert stehen müsste",
  "the scene's text has {bytes} bytes, more than the {most} that are read":
    "der Text der Szene hat {bytes} Bytes, mehr als die {most}, die gelesen werden",
  "{what}: {count} are more than the {limit} that a scene may have":
    "{what}: {count} sind mehr als die {limit}, die eine Szene haben darf",
  'the scene has no parameter "{name}"': "die Szene hat keinen Parameter „{name}“",
  'parameter "{name}": {value} is not between {low} and {high}':
    "Parameter „{name}“: {value} liegt nicht zwischen {low} und {high}",
  "{pointer}: {value} is not a finite number": "{pointer}: {value} ist keine endliche Zahl",
  "{pointer}: {value} is not between {low} and {high}":
    "{pointer}: {value} liegt nicht zwischen {low} und {high}",
  "the scene has no bodies": "die Szene hat keine Körper",
  '{list}[{index}]: the name "{name}" is already used by {other}':
    "{list}[{index}]: Den Namen „{name}“ hat schon {other}",
  '{list}[{index}]: "{name}" cannot be the name of an element':
    "{list}[{index}]: „{name}“ kann kein Name sein",
  'joint "{joint}": there is no body "{name}"': "Gelenk „{joint}“: Es gibt keinen Körper „{name}“",
  'driver "{driver}": there is no body "{name}"': "Antrieb „{driver}“: Es gibt keinen Körper „{name}“",
  'load "{load}": there is no body "{name}"': "Last „{load}“: Es gibt keinen Körper „{name}“",
  'marker "{marker}": there is no body "{name}"': "Marke „{marker}“: Es gibt keinen Körper „{name}“",
  'event "{event}": there is no body "{name}"': "Ereignis „{event}“: Es gibt keinen Körper „{name}“",
  'driver "{driver}": there is no joint "{name}"': "Antrieb „{driver}“: Es gibt kein Gelenk „{name}“",
  'load "{load}": there is no joint "{name}"': "Last „{load}“: Es gibt kein Gelenk „{name}“",
  'event "{event}": there is no joint "{name}"': "Ereignis „{event}“: Es gibt kein Gelenk „{name}“",
  'joint "{joint}": there is no joint "{name}" before it; a gear is written after its two joints':
    "Gelenk „{joint}“: Davor gibt es kein Gelenk „{name}“; ein Zahnradpaar steht hinter seinen beiden Gelenken",
  'event "{event}": there is no marker "{name}"': "Ereignis „{event}“: Es gibt keine Marke „{name}“",
  'output "{output}": there is no {what} "{name}"':
    "Ausgabe „{output}“: Es gibt dort nichts mit dem Namen „{name}“ ({what})",
  'output "{output}": there is nothing that {kind} could be wanted of by name':
    "Ausgabe „{output}“: Es gibt nichts, wovon {kind} mit Namen verlangt werden könnte",
  "Write a word alone, like reactions, or with the name of one element behind a colon, like reactions:pin.":
    "Schreib ein Wort allein, wie reactions, oder mit dem Namen eines Elements hinter einem Doppelpunkt, wie reactions:pin.",
  'joint "{joint}" is {kind}, and it needs one that is {kinds}':
    "Gelenk „{joint}“ ist von der Art {kind}, gebraucht wird hier eines der Art {kinds}",
  'there is no {what} "{name}"': "es gibt dort nichts mit dem Namen „{name}“ ({what})",
  'joint "{joint}": it joins "{body}" to itself': "Gelenk „{joint}“: Es verbindet „{body}“ mit sich selbst",
  'body "{body}": its mass is {mass} kg, but a mass must be positive':
    "Körper „{body}“: Seine Masse ist {mass} kg, eine Masse muss aber positiv sein",
  'body "{body}": its principal moments of inertia {moments} kg m² break the triangle inequality (each must be at least zero and at most the sum of the other two)':
    "Körper „{body}“: Seine Hauptträgheitsmomente {moments} kg m² verletzen die Dreiecksungleichung (keines darf negativ oder größer als die Summe der beiden anderen sein)",
  'body "{body}": its inertia tensor is not symmetric (I[{row}][{column}] differs by {difference} kg m²)':
    "Körper „{body}“: Sein Trägheitstensor ist nicht symmetrisch (I[{row}][{column}] weicht um {difference} kg m² ab)",
  'attached[{index}] of body "{body}": its mass is {mass} kg, but a mass must be positive':
    "attached[{index}] von Körper „{body}“: Seine Masse ist {mass} kg, eine Masse muss aber positiv sein",
  'attached[{index}] of body "{body}": its principal moments of inertia {moments} kg m² break the triangle inequality (each must be at least zero and at most the sum of the other two)':
    "attached[{index}] von Körper „{body}“: Seine Hauptträgheitsmomente {moments} kg m² verletzen die Dreiecksungleichung (keines darf negativ oder größer als die Summe der beiden anderen sein)",
  'attached[{index}] of body "{body}": its inertia tensor is not symmetric (I[{row}][{column}] differs by {difference} kg m²)':
    "attached[{index}] von Körper „{body}“: Sein Trägheitstensor ist nicht symmetrisch (I[{row}][{column}] weicht um {difference} kg m² ab)",
  'body "{body}": {reason}': "Körper „{body}“: {reason}",
  'joint "{joint}": {reason}': "Gelenk „{joint}“: {reason}",
  'driver "{driver}": {reason}': "Antrieb „{driver}“: {reason}",
  'load "{load}": {reason}': "Last „{load}“: {reason}",
  "its formula has no power series at t = {time} s, within the run of {duration} s: its value or a derivative of it is infinite there, or too large for numbers on the way to it":
    "Ihre Formel hat bei t = {time} s, innerhalb des Laufs von {duration} s, keine Potenzreihe: Ihr Wert oder eine Ableitung ist dort unendlich oder unterwegs zu groß für Zahlen",
  "u and v are not perpendicular unit vectors: |u| = {u}, |v| = {v}, u·v = {w}":
    "u und v sind keine zueinander senkrechten Einheitsvektoren: |u| = {u}, |v| = {v}, u·v = {w}",
  "u, v, w are left-handed: w must be u × v, not its opposite":
    "u, v, w sind linkshändig: w muss u × v sein, nicht das Gegenteil",
  "w is not u × v": "w ist nicht u × v",
  "the quaternion has the norm {norm}, not 1": "das Quaternion hat den Betrag {norm} statt 1",
  "the axis of the rotation has no length": "die Drehachse hat keine Länge",
  "the orientation is given in none of the three ways, or in more than one":
    "die Orientierung ist auf keine der drei Weisen gegeben oder auf mehr als eine",
  "the vector has no length": "der Vektor hat keine Länge",
  "it has no point": "es hat keinen Punkt",
  "its point is given twice, or on one of its bodies only":
    "sein Punkt ist zweimal gegeben oder nur auf einem seiner Körper",
  "it has no axis": "es hat keine Achse",
  "its axis is given twice, or on one of its bodies only":
    "seine Achse ist zweimal gegeben oder nur auf einem seiner Körper",
  "a spherical joint has no axis": "ein Kugelgelenk hat keine Achse",
  'a universal joint has two axes: give "axes"': 'ein Kardangelenk hat zwei Achsen: Schreib "axes"',
  "a screw needs a pitch": "eine Schraube braucht eine Steigung",
  "only a screw has a pitch": "nur eine Schraube hat eine Steigung",
  "only a rod has a length": "nur ein Stab hat eine Länge",
  "the pitch of a screw is a number other than zero":
    "die Steigung einer Schraube ist eine Zahl, die nicht null ist",
  "its points coincide, and no length is given":
    "seine Punkte fallen zusammen, und eine Länge ist nicht gegeben",
  "it acts on the ground, which cannot move": "sie wirkt auf das Gestell, das sich nicht bewegen kann",

  "{pointer}: there is nothing; {other} has the keys {keys}":
    "{pointer}: Dort steht nichts; {other} hat die Schlüssel {keys}",
  "{pointer}: there is nothing; {other} is a list of {n}":
    "{pointer}: Dort steht nichts; {other} ist eine Liste mit {n} Einträgen",
  "{pointer}: there stand the keys {keys}": "{pointer}: Dort stehen die Schlüssel {keys}",
  "{pointer}: a list stands there: name one of its entries, like {other}":
    "{pointer}: Dort steht eine Liste: Nenn einen ihrer Einträge, wie {other}",
  '{pointer}: the word "{word}" stands there': "{pointer}: Dort steht das Wort „{word}“",
  'parameter "{name}": {pointer}: its value {value} is outside its range from {low} to {high}':
    "Parameter „{name}“: {pointer}: Sein Wert {value} liegt außerhalb seines Bereichs von {low} bis {high}",
  'parameter "{name}": {reason}': "Parameter „{name}“: {reason}",

  // What helps.
  'Did you mean "{name}"?': "Meintest du „{name}“?",
  '"{key}" is one of the settings: write it within "simulation".':
    "„{key}“ ist eine der Einstellungen: Es gehört in „simulation“.",
  "Compare the place with the JSON Schema of a scene (`triad schema`).":
    "Vergleiche die Stelle mit dem JSON-Schema einer Szene (`triad schema`).",
  "Add at least one body with a name and a mass.": "Schreib wenigstens einen Körper mit Namen und Masse.",
  "Give each element of a list its own name; joints and drivers share one list of names.":
    "Gib jedem Element einer Liste einen eigenen Namen; Gelenke und Antriebe teilen sich eine Liste von Namen.",
  "Divide its components by its length, or give a vector that turns about an axis, which keeps its length.":
    "Teil ihre Komponenten durch ihre Länge, oder gib einen Vektor, der sich um eine Achse dreht: Er behält seine Länge.",
  "Leave it out.": "Lass es weg.",
  'Choose a name that is not empty, has no line breaks, and is not "ground", which is the fixed body.':
    "Wähl einen Namen, der nicht leer und nicht „ground“ ist (so heißt das Gestell) und keine Zeilenumbrüche hat.",
  "Use the name of a {what} of the scene.": "Nimm einen Namen, den es in der Szene gibt ({what}).",
  'Use the name of one of the bodies, or "ground".': "Nimm den Namen eines der Körper oder „ground“.",
  'Name two different bodies, one of which may be "ground".':
    "Nenn zwei verschiedene Körper; einer darf „ground“ sein.",
  "Name a place that holds a number, by keys and places in lists from 0, like /bodies/0/mass.":
    "Nenn eine Stelle, an der eine Zahl steht, durch Schlüssel und Plätze in Listen ab 0, wie /bodies/0/mass.",
  "Its parameters are {names}.": "Ihre Parameter sind {names}.",
  "Ask for a {what} by its name in the scene.": "Nenn es ({what}) mit seinem Namen in der Szene.",
  "Write an ordinary number.": "Schreib eine gewöhnliche Zahl.",
  "Choose a value from {low} to {high}.": "Wähl einen Wert von {low} bis {high}.",
  "Choose a value from {low} to {high}, or change the number by its JSON pointer.":
    "Wähl einen Wert von {low} bis {high}, oder ändere die Zahl an ihrer Stelle in der Szene.",
  "Give a positive mass in kg; a light body may have 1e-9 kg.":
    "Gib eine positive Masse in kg; ein leichter Körper darf 1e-9 kg haben.",
  "Check the units (kg m²) and that the moments are about the centre of mass; for a flat body the largest is the sum of the other two.":
    "Prüf die Einheit (kg m²) und ob die Momente um den Schwerpunkt gelten; bei einem flachen Körper ist das größte die Summe der beiden anderen.",
  "Write the same number on both sides of the diagonal; off-diagonal entries are minus the products of inertia.":
    "Schreib auf beide Seiten der Diagonale dieselbe Zahl; neben ihr stehen die negativen Deviationsmomente.",
  "Give either u and v (perpendicular unit vectors), or a unit quaternion [w, x, y, z], or an axis and an angle in radians.":
    "Gib entweder u und v (zueinander senkrechte Einheitsvektoren), ein Einheitsquaternion [w, x, y, z] oder eine Achse und einen Winkel in Radiant.",
  "Give points and axes either in the world at the start (point, axis, axes) or in the frames of both bodies (point_i and point_j, axis_i and axis_j).":
    "Gib Punkte und Achsen entweder in der Welt am Anfang (point, axis, axes) oder in den Systemen beider Körper (point_i und point_j, axis_i und axis_j).",
  "Give a vector that is not zero, such as [0, 0, 1]: its length does not matter.":
    "Gib einen Vektor, der nicht null ist, etwa [0, 0, 1]: Auf seine Länge kommt es nicht an.",
  "Leave it out, or choose a kind of joint that has it.":
    "Lass das weg, oder wähl eine Art von Gelenk, die es hat.",
  "Give what body j advances in a whole turn, in m; a negative number for a left-handed thread.":
    "Gib an, wie weit Körper j in einer ganzen Umdrehung vorrückt, in m; eine negative Zahl für ein Linksgewinde.",
  "Set the two points of the rod apart, or put a spherical joint in its place.":
    "Rück die beiden Punkte des Stabs auseinander, oder setz ein Kugelgelenk an seine Stelle.",
  "Compare the joint with the JSON Schema of a scene (`triad schema`).":
    "Vergleiche das Gelenk mit dem JSON-Schema einer Szene (`triad schema`).",
  "Compare the element with the JSON Schema of a scene; points and vectors of a body are in its own frame.":
    "Vergleiche das Element mit dem JSON-Schema einer Szene; Punkte und Vektoren eines Körpers gelten in seinem eigenen System.",
  "Change the formula so that it has a value and all derivatives in the whole run, let the run end before, or write a table instead.":
    "Ändere die Formel so, dass sie im ganzen Lauf einen Wert und alle Ableitungen hat, lass den Lauf vorher enden, oder gib stattdessen eine Tabelle.",
  "A parameter names numbers of this scene by JSON pointers from 0, like /bodies/0/mass, and a range that holds the number written there.":
    "Ein Parameter nennt Zahlen dieser Szene durch JSON-Zeiger ab 0, wie /bodies/0/mass, und einen Bereich, in dem die Zahl dort liegt.",
  "Split the mechanism, or leave out what does not move.":
    "Teil den Mechanismus, oder lass weg, was sich nicht bewegt.",
  "Let the driver begin where the stated positions stand: angles count from those, slides are the distance of the joint's points along the axis. Or state the bodies where the driver begins.":
    "Lass den Antrieb da beginnen, wo die angegebenen Lagen stehen: Winkel zählen von dort, Verschiebungen sind der Abstand der Gelenkpunkte längs der Achse. Oder gib die Körper da an, wo der Antrieb beginnt.",
  "Check the points and axes of that joint on both of its bodies, and the positions of the bodies.":
    "Prüf die Punkte und Achsen dieses Gelenks auf beiden Körpern und die Lagen der Körper.",
  "Let the driver stand still there, free one of the joints that are named, or leave out one of two drivers that contradict each other: `triad check` tells the degrees of freedom.":
    "Lass den Antrieb dort stillstehen, löse eines der genannten Gelenke, oder lass einen von zwei Antrieben weg, die sich widersprechen: `triad check` sagt die Freiheitsgrade.",
  'Make the light bodies heavier, or leave them out: a rod without mass between two bodies is a joint of the kind "rod".':
    "Mach die leichten Körper schwerer, oder lass sie weg: Ein Stab ohne Masse zwischen zwei Körpern ist ein Gelenk der Art „rod“.",
  "Give the body a moment of inertia about that axis, let a joint keep it from turning about it, or let the load act in points of the axis.":
    "Gib dem Körper ein Trägheitsmoment um diese Achse, lass ein Gelenk ihn daran hindern, sich um sie zu drehen, oder lass die Last in Punkten der Achse angreifen.",
  "Prescribe the angle of a joint (angle) or a direction (vector), which hold everywhere, or choose vectors that are at right angles in the middle of the motion.":
    "Schreib den Winkel eines Gelenks vor (angle) oder eine Richtung (vector), die überall halten, oder wähle Vektoren, die in der Mitte der Bewegung im rechten Winkel stehen.",
  "Look at the last good state: a driver asks for more than the joints allow, two of them contradict each other, joints that hold the same are not aligned, masses or stiffnesses are too different for the tolerance, or the stabilization is too weak.":
    "Sieh dir den letzten guten Zustand an: Ein Antrieb verlangt mehr, als die Gelenke erlauben, zwei widersprechen sich, Gelenke, die dasselbe halten, sind nicht ausgerichtet, Massen oder Steifigkeiten sind zu verschieden für die Toleranz, oder die Stabilisierung ist zu schwach.",
  "Loosen the tolerance, and look at the last good state.":
    "Lockere die Toleranz, und sieh dir den letzten guten Zustand an.",
  "Loosen the tolerance, use projection as the stabilization, and look at the last good state for a joint that locks or a body that is far too light.":
    "Lockere die Toleranz, nimm Projektion als Stabilisierung, und such im letzten guten Zustand nach einem Gelenk, das klemmt, oder einem viel zu leichten Körper.",
  "Take shorter steps than those of {size} s, or leave their size to the tolerance.":
    "Nimm kürzere Schritte als die von {size} s, oder überlass ihre Länge der Toleranz.",
  "Take shorter steps than those of {size} s, or leave their size to the tolerance; through singular positions use taylor or dop853 with projection.":
    "Nimm kürzere Schritte als die von {size} s, oder überlass ihre Länge der Toleranz; durch singuläre Lagen nimm taylor oder dop853 mit Projektion.",
  "Take shorter steps, or none of one size: methods that choose their steps count turns.":
    "Nimm kürzere Schritte oder keine von fester Größe: Verfahren, die ihre Schritte selbst wählen, zählen Umdrehungen.",
  "Tighten the tolerance, which shortens the steps; through singular positions use taylor or dop853 with projection.":
    "Verschärf die Toleranz, das verkürzt die Schritte; durch singuläre Lagen nimm taylor oder dop853 mit Projektion.",
  "Use projection as the stabilization, with taylor or dop853.":
    "Nimm Projektion als Stabilisierung, mit taylor oder dop853.",
  "Allow more steps, loosen the tolerance, or look for a stiff spring or a fast driver.":
    "Erlaub mehr Schritte, lockere die Toleranz, oder such nach einer steifen Feder oder einem schnellen Antrieb.",
  "Ask for a later time, or reset the run first.":
    "Frag nach einer späteren Zeit, oder setz den Lauf erst zurück.",
  'Ask for a time within the run: it ends after the "duration" in the scene\'s "simulation", or at an event that stops it.':
    "Frag nach einer Zeit innerhalb des Laufs: Er endet nach der „duration“ in „simulation“ der Szene oder bei einem Ereignis, das ihn anhält.",
  "this server runs without accounts: its grades are for yourself":
    "Dieser Server läuft ohne Konten: Seine Bewertungen sind für dich selbst",
  "for a class start it with `triad serve --class`": "Für einen Kurs starte ihn mit „triad serve --class“",
  "Look at the last good state: let the driver ask for less, change lengths, or end the run before.":
    "Sieh dir den letzten guten Zustand an: Lass den Antrieb weniger verlangen, ändere Längen, oder beende den Lauf vorher.",
  "Loosen the tolerance, tenfold at first: the mechanism comes to a singular position, near which rounding is larger than this one allows. Else change lengths, or end the run before.":
    "Lockere die Toleranz, zuerst auf das Zehnfache: Der Mechanismus kommt in eine singuläre Lage, bei der die Rundung größer ist, als sie erlaubt. Sonst ändere Längen, oder beende den Lauf vorher.",
  "Look at the last good state: the mechanism comes to a singular position. Use taylor or dop853 with projection, change lengths, or end the run before.":
    "Sieh dir den letzten guten Zustand an: Der Mechanismus kommt in eine singuläre Lage. Nimm taylor oder dop853 mit Projektion, ändere Längen, oder beende den Lauf vorher.",
  "Move the points or axes of that joint away from the singular position that it starts in, or leave it out if others hold the same.":
    "Rück die Punkte oder Achsen dieses Gelenks von der singulären Lage weg, in der es beginnt, oder lass es weg, wenn andere dasselbe halten.",
};
